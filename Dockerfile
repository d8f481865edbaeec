# The explorer for a team: see docs/how-to/serve.md
FROM python:3.12-slim AS build
COPY . /source
RUN pip wheel --no-cache-dir --no-deps --wheel-dir /wheels /source

FROM python:3.12-slim
COPY --from=build /wheels /wheels
RUN pip install --no-cache-dir "$(ls /wheels/*.whl)[app]" \
 && rm -r /wheels && useradd --create-home --shell /usr/sbin/nologin hips
USER hips
ENV OPENBLAS_NUM_THREADS=1 PYTHONDONTWRITEBYTECODE=1
EXPOSE 5006
# the names under which browsers reach it: docker run ... ballsocket --origin hips.example.org
ENTRYPOINT ["ballsocket", "app", "--address", "0.0.0.0", "--no-browser"]
HEALTHCHECK --interval=30s --timeout=10s CMD ["python", "-c", "import socket; socket.create_connection(('127.0.0.1', 5006), 5)"]
