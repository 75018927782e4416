# Built by nobody here yet: written from what pip does in a checkout. docker build -t tmm-sheets . && docker run --rm -v "$PWD:/work" tmm-sheets build press
FROM python:3.12-slim
COPY . /src
RUN pip install --no-cache-dir "/src[note,compare]" && rm -rf /src
ENV TMM_SHEETS_CACHE=/tmp/tmm-sheets
WORKDIR /work
ENTRYPOINT ["tmm-sheets"]
