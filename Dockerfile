# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
# The program `glidar` in a small image:
#   docker build -t glidar .
#   docker run --rm --user "$(id -u):$(id -g)" -v "$PWD:/data" glidar render MODEL -o cloud.pcd
FROM debian:12 AS build
COPY . /glidar
WORKDIR /glidar
RUN ./dev package

FROM debian:12-slim
COPY --from=build /glidar/out/glidar_*.deb /tmp/
RUN apt-get update && apt-get install -y /tmp/glidar_*.deb && rm -rf /tmp/glidar_*.deb /var/lib/apt/lists/*
RUN useradd --create-home glidar
USER glidar
# any user may be chosen when the container runs; the cache of models is the container's own
ENV XDG_CACHE_HOME=/tmp
WORKDIR /data
ENTRYPOINT ["glidar"]
CMD ["--help"]
