#!/usr/bin/env bash
# hot_path.sh PROGRAM: succeeds when the inner loops of a program that was compiled with -fno-jump-tables make no indirect call.
#
# From the loops over pixels and light paths (Frame::sample_tile, Frame::trace_paths) it follows every direct call inside the
# program. No instruction met on the way may call or jump through a register or memory (the stubs through which a program calls
# shared libraries are not followed: Embree is one of those), and no class of the library may have a virtual function table,
# except its exception and what descriptions hold.
set -u
program=${1:?usage: hot_path.sh PROGRAM}

tables=$(nm -C "$program" | grep -E ' vtable for lightswitch::' | grep -vE ' vtable for lightswitch::(Error$|(AnyMaterial|Source)::Model<)')
if [ -n "$tables" ]; then
  echo "virtual function tables:"
  echo "$tables"
  exit 1
fi

objdump -d --no-show-raw-insn "$program" | awk '
  /^[0-9a-f]+ <.*>:$/ { name = $2; sub(/^</, "", name); sub(/>:$/, "", name); next }
  name ~ /@plt$/ { next }
  $2 ~ /^(notrack|bnd)$/ { $2 = $3; $3 = $4 }
  $2 ~ /^(call|jmp)q?$/ && $3 ~ /^\*/ { indirect[name] = indirect[name] "\n    " $0 }
  $2 ~ /^(call|j[a-z]+)q?$/ && match($0, /<[^>]*>/) {
    target = substr($0, RSTART + 1, RLENGTH - 2)
    sub(/\+0x[0-9a-f]+$/, "", target)
    if (target != name) calls[name] = calls[name] " " target
  }
  { known[name] = 1 }
  END {
    for (f in known) if (f ~ /lightswitch/ && f ~ /5Frame/ && f ~ /11sample_tile|11trace_paths/) { queue[++n] = f; seen[f] = 1; ++roots }
    for (i = 1; i <= n; ++i) {
      if (queue[i] in indirect) { print "indirect calls in " queue[i] ":" indirect[queue[i]]; bad = 1 }
      m = split(calls[queue[i]], next_ones, " ")
      for (j = 1; j <= m; ++j) {
        t = next_ones[j]
        if (t ~ /@plt$/) { library[t] = 1; continue }
        if (!(t in seen)) { seen[t] = 1; queue[++n] = t }
      }
    }
    printf "%d inner loops, %d functions reached; shared library functions called:", roots, n
    for (t in library) { sub(/@plt$/, "", t); printf " %s", t }
    print ""
    if (roots < 1) { print "no inner loop was found"; bad = 1 }
    exit bad
  }'
