#!/bin/bash
# A movie from the images of a run:
#   postprocessing/make_movie.sh results/perivessel/images [movie.mp4] [frames per second]
# The movie's default place is beside the folder of images.
set -euo pipefail
[ -d "${1-}" ] || { echo "usage: make_movie.sh IMAGE_DIRECTORY [MOVIE.mp4] [FRAMES_PER_SECOND]" >&2; exit 2; }
images=$1
movie=${2:-$(dirname "$(realpath "$images")")/movie.mp4}
rate=${3:-12}
command -v ffmpeg > /dev/null || { echo "error: ffmpeg is not installed (Debian: ffmpeg)" >&2; exit 1; }
compgen -G "$images/vessel_*.png" > /dev/null || { echo "error: no vessel_*.png in $images" >&2; exit 1; }
# In the order of their numbers; the last image stays for another second.
ls -v "$images"/vessel_*.png | xargs -d '\n' cat | ffmpeg -y -loglevel error -f image2pipe -framerate "$rate" -i - \
  -vf tpad=stop_mode=clone:stop_duration=1 -c:v libx264 -pix_fmt yuv420p -crf 18 -movflags +faststart "$movie"
echo "$movie"
