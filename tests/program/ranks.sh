#!/bin/bash
# Renders by the processes of MPI jobs, against those of one process: the same bits, whatever is asked for and whatever dies.
#
#   ranks.sh PROGRAM
#
# Ends with 77 where there is no mpirun, or the program was built without MPI.

set -uo pipefail
program=$(realpath "$1")
command -v mpirun >/dev/null || { echo "ranks.sh: there is no mpirun"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
# Open MPI: also for root, more processes than processors, and without asking the network.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_btl=self,vader
export OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_hwloc_base_binding_policy=none

failed=0
fail() { echo "ranks.sh: $1" >&2; failed=1; }
job() { timeout 120 mpirun -n "$@"; }

if job 2 "$program" render cornell-box --size 4x4 --spp 2 -o x.pfm 2>&1 | grep -q 'built without MPI'; then
    echo "ranks.sh: the program was built without MPI"
    exit 77
fi

# Every method whose iterations do not go on from one another, with filters wider than a pixel and splats.
for method in silhouette path-nee light photon vcm path-guided; do
    render=(render cornell-spheres --size 40x30 --filter gaussian --method $method --spp 23 --seed 5 --quiet)
    "$program" "${render[@]}" -o whole.pfm || fail "$method: no image"
    for ranks in 2 4; do
        rm -f x.pfm
        job $ranks "$program" "${render[@]}" --threads $((4 / ranks)) -o x.pfm || fail "$method by $ranks: no image"
        cmp -s x.pfm whole.pfm || fail "$method by $ranks: another image"
    done
done

# An error as budget: the number of samples must not depend on the number of processes.
for ranks in 1 3; do
    job $ranks "$program" render cornell-box --size 40x30 --error 0.1 --quiet -o e$ranks.pfm --stats e$ranks.json || fail "--error: no image"
done
cmp -s e1.pfm e3.pfm || fail "--error: another image"
grep -q '"processes": 3' e3.json || fail "--stats does not tell of 3 processes"
python3 - <<'PY' || fail "--error is not met, or by far more samples than it takes"
import json, sys
stats = json.load(open("e3.json"))
sys.exit(not 0.06 < stats["estimated_error"] <= 0.1)
PY

# Iterations of mlt go on from one another: every process has a seed of its own.
job 2 "$program" render cornell-box --size 32x32 --method mlt --spp 9 --seed 3 --quiet -o x.pfm || fail "mlt: no image"
"$program" render cornell-box --size 32x32 --method mlt --spp 4 --seed 3 --quiet --checkpoint a.lsw
"$program" render cornell-box --size 32x32 --method mlt --spp 5 --seed 4 --quiet --checkpoint b.lsw
"$program" merge a.lsw b.lsw --quiet -o whole.pfm
"$program" render cornell-box --size 32x32 --method mlt --spp 5 --seed 3 --quiet --checkpoint c.lsw
"$program" render cornell-box --size 32x32 --method mlt --spp 4 --seed 4 --quiet --checkpoint d.lsw
"$program" merge c.lsw d.lsw --quiet -o other.pfm
cmp -s x.pfm whole.pfm || cmp -s x.pfm other.pfm || fail "mlt: another image than that of its seeds"

# A process dies: the job ends with an error, and what was kept goes on, by one process or several.
long=(render cornell-box --size 64x64 --method bdpt --spp 400 --seed 1 --quiet)
"$program" "${long[@]}" -o whole.pfm
for ranks in 1 3; do
    rm -f k.lsw x.pfm
    mpirun -n 3 "$program" "${long[@]}" --threads 1 --checkpoint k.lsw --every 0.3 -o x.pfm 2>job.txt &
    pid=$!
    for ((i = 0; i < 200; ++i)); do [ -e k.lsw ] && break; sleep 0.1; done
    [ -e k.lsw ] || fail "nothing was kept within 20 s"
    sleep 0.2
    victim=$(pgrep -P "$pid" | shuf -n 1)
    [ -n "$victim" ] && kill -9 "$victim"
    if wait $pid; then fail "the job did not notice the death of a process"; fi
    grep -qi 'rank [0-9]' job.txt || fail "the job does not name the dead process: $(cat job.txt)"
    [ -e x.pfm ] && fail "an image was written although a process had died"
    job $ranks "$program" "${long[@]}" --checkpoint k.lsw -o x.pfm || fail "nothing goes on from what was kept"
    cmp -s x.pfm whole.pfm || fail "another image after a death, by $ranks"
done

# What is wrong is said once, and nobody waits for ever.
for words in "render nothing.xml -o x.png" "render cornell-box --method nothing -o x.png" "verify cornell-box" \
    "render cornell-box --denoise own -o x.png" "render cornell-box --method mlt --checkpoint m.lsw"; do
    job 3 "$program" $words 2>said.txt
    status=$?
    [ $status -eq 2 ] || fail "\"$words\" ends with $status"
    [ "$(grep -c 'lightswitch: error' said.txt)" -eq 1 ] || fail "\"$words\": $(cat said.txt)"
done

# Two machines: network namespaces with a host name each, and nothing but a network between them.
name=lsw$$
two_machines() {
    ip netns add ${name}a && ip netns add ${name}b && ip link add ${name}x netns ${name}a type veth peer name ${name}y netns ${name}b &&
        ip -n ${name}a addr add 10.77.0.1/24 dev ${name}x && ip -n ${name}b addr add 10.77.0.2/24 dev ${name}y &&
        ip -n ${name}a link set ${name}x up && ip -n ${name}b link set ${name}y up && ip -n ${name}a link set lo up &&
        ip -n ${name}b link set lo up && ip netns exec ${name}a unshare --uts true
}
if two_machines 2>network.txt; then
    printf '#!/bin/bash\nshift\nexec ip netns exec %sb unshare --uts bash -c "hostname machine-b; $*"\n' $name >agent
    # Each machine has a scene of its own under one name.
    mkdir machine-a machine-b
    printf '#!/bin/bash\ncd %s/$(hostname) && exec %s "$@"\n' "$folder" "$program" >there
    chmod +x agent there
    over_network() {
        ip netns exec ${name}a unshare --uts bash -c "hostname machine-a; timeout 120 mpirun --mca plm_rsh_agent $folder/agent --mca btl self,tcp \
            --mca btl_tcp_if_include 10.77.0.0/24 --mca oob_tcp_if_include 10.77.0.0/24 --host 10.77.0.1:1,10.77.0.2:1 -n 2 $folder/there $*"
    }
    scene='<scene version="3.0.0"><shape type="sphere"><emitter type="area"><rgb name="radiance" value="LIGHT"/></emitter></shape>
        <sensor type="perspective"><transform name="to_world"><lookat origin="0,0,5" target="0,0,0" up="0,1,0"/></transform></sensor></scene>'
    echo "${scene/LIGHT/1}" | tee machine-a/lamp.xml >machine-b/lamp.xml
    over_network render lamp.xml --size 40x30 --spp 23 --quiet -o x.pfm || fail "no image by two machines"
    (cd machine-a && "$program" render lamp.xml --size 40x30 --spp 23 --quiet -o whole.pfm)
    cmp -s machine-a/x.pfm machine-a/whole.pfm || fail "another image by two machines"
    echo "${scene/LIGHT/2}" >machine-b/lamp.xml
    over_network render lamp.xml --size 40x30 --spp 23 --quiet -o y.pfm 2>said.txt && fail "two scenes become one image"
    grep -q 'rank 1 (machine-b): makes other bits than rank 0' said.txt || fail "two scenes: $(cat said.txt)"
    [ -e machine-a/y.pfm ] && fail "an image of two scenes was written"
else
    echo "ranks.sh: no network namespaces here, so only one machine: $(tail -n 1 network.txt)"
fi
ip netns del ${name}a 2>/dev/null
ip netns del ${name}b 2>/dev/null

[ $failed -eq 0 ] && echo "all as by one process"
exit $failed
