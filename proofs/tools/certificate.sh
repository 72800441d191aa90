#!/bin/sh
# certificate.sh FILE.v: FILE is a certificate, line for line (proofs/README.md, "Certificates"), Coq accepts it,
# and it rests on no axiom beyond those of the standard library's reals. Needs 'make theory' first.
here=$(cd "$(dirname "$0")/.." && pwd)
file=$1

int='[0-9]+'
frac_R="\\(-?$int / $int\\)"
frac_Q="\\(-?$int # $int\\)"
kind='(Elliptic|\((Hyperbolic|Parabolic|Coexistence) (Plus|Minus)\))'
rat="-?$int(/$int)?"

line() { # line NUMBER REGEX
  sed -n "$1p" "$file" | grep -qxE -- "$2" || { echo "$file:$1: not a line of the template"; exit 1; }
}
line 1 "\\(\\* kickdrift verdict --lambda1 $rat --lambda2 $rat --h1 $rat --h2 $rat --certificate [A-Za-z0-9_]+\\.v \\*\\)"
line 2 'From Coq Require Import Reals QArith\.'
line 3 'From Kickdrift Require Import Vocabulary Certificate\.'
line 4 ''
line 5 '\(\*\* kind, p, q with h2/h1 = p/q, then h1, lambda1, h2, lambda2\. \*\)'
line 6 'Theorem kickdrift_verdict :'
line 7 "  verdict $kind $int $int $frac_R $frac_R $frac_R $frac_R\\."
line 8 "Proof\\. certify $frac_Q $frac_Q $frac_Q $frac_Q\\. Qed\\."
line 9 'Print Assumptions kickdrift_verdict\.'
# The comment must name the theorem's own input: h1, lambda1, h2, lambda2 of line 7, fractions as the program writes them.
input=$(sed -n 7p "$file" | grep -oE -- "$frac_R" | tr -d '() ' | sed 's|/1$||')
set -- $input
own="--lambda1 $2 --lambda2 $4 --h1 $1 --h2 $3"
case $(sed -n 1p "$file") in
  *"verdict $own --certificate"*) ;;
  *) echo "$file:1: the comment is not of the theorem's input, which is $own"; exit 1 ;;
esac
[ "$(wc -l < "$file")" -eq 9 ] || { echo "$file: a certificate has nine lines"; exit 1; }

[ -e "$here/Certificate.vo" ] || { echo "the theory is not compiled: run 'make theory' in $here first"; exit 1; }
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cp "$file" "$work/" || exit 1
coqc -q -R "$here" Kickdrift "$work/$(basename "$file")" > "$work/out" || { echo "$file: Coq refuses it"; exit 1; }
"$here/tools/axioms.sh" "$work/out" || exit 1
echo "proven: $file: $(sed -n 7p "$file" | sed 's/^ *//')"
