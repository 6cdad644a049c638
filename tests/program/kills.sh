#!/bin/bash
# Kills renders at random moments, many times, and compares what comes of them with renders that nothing happened to.
#
#   kills.sh PROGRAM [KILLS [SEED]]     200 kills without
#
# The methods take turns. A state is written after every iteration, so that many kills fall into the writing.

set -euo pipefail
program=$(realpath "$1")
kills=${2:-200}
RANDOM=${3:-1}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

methods=(path-nee bdpt photon vcm mlt light path phong silhouette path-guided)
killed=0 writing=0 renders=0
while ((killed < kills)); do
    method=${methods[renders % ${#methods[@]}]}
    render=("$program" render cornell-box --size 80x60 --filter gaussian --method "$method" --spp $((20 + RANDOM % 60)) --seed "$renders" --quiet)
    "${render[@]}" --output whole.pfm
    rm -f x.lsw x.pfm
    surviving=("${render[@]}" --threads $((1 + RANDOM % 2)) --checkpoint x.lsw --every 1e-6 --write-every 0.02 --output x.pfm)
    for ((of_this = 0; of_this < 40 && killed < kills; ++of_this)); do
        "${surviving[@]}" &
        pid=$!
        sleep "0.$(printf %03d $((RANDOM % 300)))"
        if ! kill -9 $pid 2>/dev/null; then break; fi
        wait $pid 2>/dev/null || true
        ((++killed))
        # What was being written is there under a name of its own.
        if compgen -G '.x.lsw.tmp-*' >/dev/null; then ((++writing)); fi
        if [[ -e x.pfm ]] && (($(stat -c %s x.pfm) != $(stat -c %s whole.pfm))); then
            echo "kills.sh: $method: half an image" >&2
            exit 1
        fi
    done
    wait
    "${surviving[@]}"
    if ! cmp -s x.pfm whole.pfm; then
        echo "kills.sh: $method: another image" >&2
        exit 1
    fi
    if compgen -G '.*.tmp-*' >/dev/null; then
        echo "kills.sh: $method: something is left behind" >&2
        exit 1
    fi
    ((++renders))
done
echo "$killed kills of $renders renders, $writing of them while a state was written: every image as if undisturbed"
