# Mortise on Debian 12:  docker build -t mortise .  &&  docker run --rm -v "$PWD:/work" -w /work mortise run deck.yaml
FROM debian:12
COPY . /opt/mortise
RUN /opt/mortise/mortise setup && /opt/mortise/mortise build && apt-get clean && rm -rf /var/lib/apt/lists/*
ENTRYPOINT ["/opt/mortise/mortise"]
