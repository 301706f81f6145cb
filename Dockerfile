# SPDX-License-Identifier: BSD-3-Clause
# Rhexis in a container. From a clone:
#   docker build -t rhexis .
#   docker run --rm -v "$PWD/results:/rhexis/results" rhexis                       the main job
#   docker run --rm -v "$PWD:/data" -w /data rhexis rhexis run mine.toml           a run of your own
# It is compiled for the processor of the machine that builds the image: build it where it runs, or on an older machine.
FROM debian:trixie-slim
COPY . /rhexis
WORKDIR /rhexis
RUN ./quickstart build && rm -rf /var/lib/apt/lists/* && ln -s /rhexis/build/release/bin/rhexis /usr/local/bin/rhexis
ENV OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
CMD ["rhexis", "run", "inputs/perivessel.toml"]
