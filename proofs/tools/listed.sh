#!/bin/sh
# listed.sh MAIN ASSUMPTIONS: every theorem of MAIN is printed in ASSUMPTIONS.
status=0
room=$(basename "$1" .v)
for t in $(sed -nE 's/^Theorem ([A-Za-z0-9_]+).*/\1/p' "$1"); do
  grep -qF "Print Assumptions $room.$t." "$2" || { echo "listed: $t is not printed in $2"; status=1; }
done
exit $status
