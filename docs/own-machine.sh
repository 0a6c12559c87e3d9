#!/bin/bash
# From a table and a data sheet to the first comparison, timed: docs/own-machine.sh [path of excavator]
set -euo pipefail
excavator="$(realpath "${1:-target/release/excavator}")"
bench="$(cd "$(dirname "$0")/../tests/blind/bench/cases/01" && pwd)"
cd "$(mktemp -d)"
cp "$bench/identification.csv" bench.csv
cp "$bench/validation.csv" other-day.csv

step() { echo; echo "\$ excavator $*"; "$excavator" "$@"; }
start="$(date +%s%N)"
step model new --drive valve --cylinder "16/10 x 100" --mass "5.5 kg" --command "5 V" \
  --rated-flow "4 l/min" --supply "70 bar" --dead-volume "15.3 cm3, 16 cm3" -o bench.toml
step import bench.csv --guess --model bench.toml -o map.toml
step compare --model bench.toml --map map.toml --bag bench.csv
echo
echo "3 commands, $((($(date +%s%N) - start) / 1000000)) ms of computing"
step diagnose --model bench.toml --map map.toml --identification bench.csv --validation other-day.csv
