# Mortise on Debian 12:  docker build -t mortise .  &&  docker run --rm -v "$PWD:/work" -w /work mortise run deck.yaml
FROM debian:12
COPY . /opt/mortise
# An image may run on another processor than it was built on: this is any since about 2015.
ENV MORTISE_ARCH=x86-64-v3
RUN /opt/mortise/mortise setup && /opt/mortise/mortise build && apt-get clean && rm -rf /var/lib/apt/lists/*
ENTRYPOINT ["/opt/mortise/mortise"]
