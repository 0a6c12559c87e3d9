#!/usr/bin/env bash
# Makes a page of every kind and takes its pictures.
#
#   tests/pages/screenshots.sh FOLDER [EXCAVATOR]
#
# EXCAVATOR is the program, target/release/excavator unless given.
set -euo pipefail

if [ $# -lt 1 ]; then sed -n '2,6s/^# \{0,1\}//p' "$0"; exit 2; fi
here="$(cd "$(dirname "$0")" && pwd)"
repository="$(cd "$here/../.." && pwd)"
program="$(realpath "${2:-$repository/target/release/excavator}")"
law="$repository/bags/samples/hidden-law"
profiles="$repository/config/profiles"
both=(--model zx30u-arm --identification "$law/identification" --validation "$law/validation")

mkdir -p "$1"
cd "$1"
make() { printf '%s\n' "$*" >&2; "$program" --quiet "$@" >/dev/null; }

rm -rf demo-files
make demo -o demo-files
cp demo-files/report.html demo.html
make compare --model zx30u-arm --bag "$law/validation" --report compare.html --force
make energy --model zx30u-arm --bag "$law/validation" --report energy.html --force
for profile in bench-trapezoids bench-sine-0.50; do
  make simulate --model servo-bench --input "$profiles/$profile.toml" -o "$profile" --force
done
make characterise --model servo-bench bench-trapezoids bench-sine-0.50 --report characterise.html --force
make diagnose "${both[@]}" --report diagnose.html --force
make propose "${both[@]}" -o laws.toml --report propose.html --force
node "$here/screenshots.mjs" demo.html compare.html energy.html characterise.html diagnose.html propose.html
