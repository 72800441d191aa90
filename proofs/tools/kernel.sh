#!/bin/sh
# kernel.sh OUTPUT: coqchk's summary names no axiom beyond those of the standard library's reals, and no unsafe trick.
allowed='Coq\.Reals\.ClassicalDedekindReals\.sig_forall_dec|Coq\.Reals\.ClassicalDedekindReals\.sig_not_dec'
allowed="$allowed|Coq\.Logic\.FunctionalExtensionality\.functional_extensionality_dep|Coq\.Logic\.Classical_Prop\.classic"

grep -q '^\* Axioms:' "$1" || { echo "kernel: no summary in $1"; exit 1; }
[ "$(grep -c '<none>' "$1")" -eq 3 ] || { cat "$1"; echo "kernel: an unsafe construction"; exit 1; }
if sed -n '/^\* Axioms:/,/^\* Constants/p' "$1" | grep '^    ' | grep -vxE " *($allowed)"; then
  echo "kernel: the lines above are not allowed in $1"; exit 1
fi
