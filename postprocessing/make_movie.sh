#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# A movie from the images of a run, <series>_<number>.png; of several series the one with most:
#   postprocessing/make_movie.sh results/perivessel/images [movie.mp4] [frames per second]
# The movie's default place is beside the folder of images.
set -euo pipefail
[ -d "${1-}" ] || { echo "usage: make_movie.sh IMAGE_DIRECTORY [MOVIE.mp4] [FRAMES_PER_SECOND]" >&2; exit 2; }
images=$1
movie=${2:-$(dirname "$(realpath "$images")")/movie.mp4}
rate=${3:-12}
command -v ffmpeg > /dev/null || { echo "error: ffmpeg is not installed (Debian: ffmpeg)" >&2; exit 1; }
series=$(find "$images" -maxdepth 1 -name '*_[0-9]*.png' -printf '%f\n' | sed -n 's/_[0-9]\+\.png$//p' | sort | uniq -c |
  sort -k1,1nr -k2 | sed -n '1s/^ *[0-9]* //p')
[ -n "$series" ] || { echo "error: no numbered pictures in $images" >&2; exit 1; }
# In the order of their numbers; the last image stays for another second.
ls -v "$images/$series"_[0-9]*.png | xargs -d '\n' cat | ffmpeg -y -loglevel error -f image2pipe -framerate "$rate" -i - \
  -vf tpad=stop_mode=clone:stop_duration=1 -c:v libx264 -pix_fmt yuv420p -crf 18 -movflags +faststart "$movie"
echo "$movie"
