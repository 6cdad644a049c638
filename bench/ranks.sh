#!/bin/bash
# What the processes of an MPI job gain: time of two with a thread each over that of one, in turn.
#
#   ranks.sh PROGRAM [PAIRS [SAMPLES]]      5 pairs of 400 samples without
#
# Prints the median of the ratios, what was sent and waited, and the memory of a process of each kind. Needs two processors that
# nobody else uses.

set -euo pipefail
program=$(realpath "$1")
pairs=${2:-5} samples=${3:-400}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_btl=self,vader
for ((i = 0; i < pairs; ++i)); do
    for processes in 1 2; do
        mpirun -n $processes /usr/bin/time -f %M -a -o memory$processes "$program" render cornell-spheres --size 256x256 --spp "$samples" \
            --threads 1 --quiet --output x$processes.pfm --stats stats$processes-$i.json
    done
    cmp x1.pfm x2.pfm
done
python3 - "$pairs" <<'PY'
import json, statistics, sys
runs = [[json.load(open(f"stats{n}-{i}.json")) for i in range(int(sys.argv[1]))] for n in (1, 2)]
ratios = [one["seconds"] / two["seconds"] for one, two in zip(*runs)]
two = runs[1][0]
print("speed-up of two processes:", " ".join(f"{r:.3f}" for r in ratios), f"  median {statistics.median(ratios):.3f}")
print(f"sent by one at most: {two['most_bytes_sent'] / (two['width'] * two['height']):.1f} bytes a pixel and gathering, {two['gatherings']} of these; "
      f"waited: {100 * two['most_seconds_waited'] / two['seconds']:.1f} %")
for n in (1, 2):
    print(f"memory of one of {n}: {max(int(line) for line in open(f'memory{n}')) / 1024:.0f} MiB")
PY
