#!/bin/sh
# axioms.sh OUTPUT: the output of Print Assumptions names no axiom beyond those of the standard library's reals.
allowed='ClassicalDedekindReals\.sig_forall_dec|ClassicalDedekindReals\.sig_not_dec'
allowed="$allowed|FunctionalExtensionality\.functional_extensionality_dep|Classical_Prop\.classic"

grep -qE '^(Axioms:|Closed under the global context)' "$1" || { echo "axioms: no Print Assumptions output in $1"; exit 1; }
if grep -E '^[^ ]' "$1" | grep -vE "^(Axioms:|Closed under the global context|(Main|MatrixSigns|ImplicitExplicitModes)\.[A-Za-z0-9_]+|($allowed)( :.*)?)$"; then
  echo "axioms: the lines above are not allowed in $1"; exit 1
fi
