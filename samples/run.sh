#!/usr/bin/env bash
# samples/run.sh [CMAKE_OPTION...]: builds the program `lightswitch` and the samples, runs them, and says where their
# pictures are; installs what is missing first (Debian, Ubuntu). Environment: .ci/setup.sh.
#
# The exit status is 0 only when everything was built and ran.
set -u
source "$(dirname "${BASH_SOURCE[0]}")/../.ci/setup.sh"

# Runs everything in the directory of the built programs; the pictures go to pictures/ in it.
run_samples() {
  local status=0
  mkdir -p pictures && cd pictures || return 1
  run() {
    echo "\$ $*"
    "$@" || { echo "samples: $1 failed" >&2; status=1; }
  }

  run ../lightswitch methods
  run ../lightswitch info cornell-sculpture
  run ../lightswitch render cornell-spheres --spp 64 --seed 1 --output spheres.exr --output spheres.png
  run ../lightswitch render cornell-spheres --spp 64 --method path --output spheres-path.exr --stats spheres-path.json
  run ../lightswitch compare spheres.exr spheres-path.exr --output spheres-difference.png
  for method in light bdpt photon vcm mlt path-guided; do
    run ../lightswitch render cornell-spheres --spp 16 --method $method --output spheres-$method.png --output spheres-$method.exr
  done
  run ../lightswitch strategies cornell-spheres --size 96x96 --spp 16 --output spheres-strategies.png
  run ../01_minimal
  run ../02_switch phong
  run ../03_own_method
  run ../04_own_bsdf
  run ../05_comparison .
  run ../06_verify
  run ../07_own_light
  run ../08_own_camera
  run ../09_own_methods
  if [ -x ../10_own_window ] && [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then run ../10_own_window --frames 20; fi
  run ../lightswitch compare spheres.exr spheres-path.exr --report spheres.html
  run ../lightswitch verify furnace --methods path-nee,bdpt --report furnace-verdict.html
  run ../lightswitch sweep cornell-spheres --size 64x64 --seconds 0.1 --report spheres-sweep.html

  echo "samples: the pictures are in $PWD"
  return $status
}

configure_project "$@" && build_targets lightswitch_samples || exit 1
cd "$build/samples" && run_samples
