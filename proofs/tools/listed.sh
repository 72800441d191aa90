#!/bin/sh
# listed.sh MAIN ASSUMPTIONS: every theorem of MAIN is printed in ASSUMPTIONS.
status=0
for t in $(sed -nE 's/^(Theorem|Lemma|Corollary) ([A-Za-z0-9_]+).*/\2/p' "$1"); do
  grep -qF "Print Assumptions Main.$t." "$2" || { echo "listed: $t is not printed in $2"; status=1; }
done
exit $status
