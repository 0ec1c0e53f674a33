#!/bin/sh
# From the folder that `schuler run simulate.yaml` wrote to the files here: increments rounded to 1e-9 rad and 1e-7 m/s, far
# below their noise; only the rows and columns that are read.
set -eu
awk -F, 'NR == 1 { print; next } { printf "%.2f,%.9f,%.9f,%.9f,%.7f,%.7f,%.7f\n", $1, $2, $3, $4, $5, $6, $7 }' "$1/imu.csv" | gzip -9n > imu.csv.gz
awk -F, 'NR == 1 { print; next } { printf "%d,%.11f,%.11f,%.4f,%s,%s,%s\n", $1, $2, $3, $4, $5, $6, $7 }' "$1/position.csv" > position.csv
cut -d, -f1-10 "$1/truth.csv" | gzip -9n > truth.csv.gz
