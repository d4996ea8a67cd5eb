# syntax=docker/dockerfile:1
ARG PYTHON_IMAGE=python:3.13-slim

# Everything that only the installation needs stays in this stage.
FROM ${PYTHON_IMAGE} AS build
WORKDIR /srv/microtexture
RUN python -m venv /opt/microtexture
COPY requirements.lock ./
RUN /opt/microtexture/bin/pip install --no-cache-dir --disable-pip-version-check --require-hashes -r requirements.lock
COPY pyproject.toml README.md LICENSE ./
COPY samples samples
COPY static static
COPY templates templates
COPY app app
RUN /opt/microtexture/bin/pip install --no-cache-dir --disable-pip-version-check --no-deps --no-build-isolation . \
    && /opt/microtexture/bin/pip uninstall --yes hatchling trove-classifiers pathspec pluggy pip

FROM ${PYTHON_IMAGE}
LABEL org.opencontainers.image.title="Microtexture" \
      org.opencontainers.image.description="Texture synthesis by example as a self-hosted web service" \
      org.opencontainers.image.licenses="BSD-3-Clause"
RUN groupadd --gid 10001 microtexture \
    && useradd --uid 10001 --gid 10001 --no-create-home --home-dir /nonexistent --shell /usr/sbin/nologin microtexture \
    && install --directory --owner microtexture --group microtexture /data
COPY --from=build /opt/microtexture /opt/microtexture
WORKDIR /data
ENV PATH=/opt/microtexture/bin:$PATH \
    HOME=/tmp \
    PYTHONDONTWRITEBYTECODE=1 \
    PYTHONUNBUFFERED=1 \
    MICROTEXTURE_DATA_DIR=/data \
    MICROTEXTURE_HOST=0.0.0.0 \
    MICROTEXTURE_PORT=8000
USER 10001:10001
VOLUME /data
EXPOSE 8000
# Ready means that experiments can run; the first start stores the bundled samples, hence the start period.
HEALTHCHECK --interval=30s --timeout=5s --start-period=60s --retries=3 \
    CMD ["python", "-c", "import os, urllib.request as r; r.urlopen('http://127.0.0.1:' + os.environ['MICROTEXTURE_PORT'] + '/readyz', timeout=4)"]
CMD ["microtexture", "serve"]
