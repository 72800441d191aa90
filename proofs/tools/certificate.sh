#!/bin/sh
# certificate.sh FILE.v: FILE is a certificate, line for line (proofs/README.md, "Certificates"), Coq accepts it,
# and it rests on no axiom beyond those of the standard library's reals. Needs 'make theory' first.
here=$(cd "$(dirname "$0")/.." && pwd)
file=$1

int='[0-9]+'
frac_R="\\(-?$int / $int\\)"
frac_Q="\\(-?$int # $int\\)"
power="($int|\\(-$int\\))"
pi_R="\\(-?$int / $int \\* powerRZ PI $power\\)"
pi_Q="\\(-?$int # $int, $power%Z\\)"
kind='(Elliptic|\((Hyperbolic|Parabolic|Coexistence) (Plus|Minus)\))'
rat="-?$int(/$int)?(\\*pi\\^-?$int)?"
name='[A-Za-z0-9_]+\.v'

line() { # line NUMBER REGEX
  sed -n "$1p" "$file" | grep -qxE -- "$2" || { echo "$file:$1: not a line of the template"; exit 1; }
}
lines() { # lines NUMBER
  [ "$(wc -l < "$file")" -eq "$1" ] || { echo "$file: a certificate of this kind has $1 lines"; exit 1; }
}
# The numbers of a line as the program writes them in the comment.
numbers() { sed -n "$1p" "$file" | grep -oE -- "$frac_R|$pi_R" | tr -d '() ' | sed -E 's|\*powerRZPI|*pi^|; s|/1(\*.*)?$|\1|; s|\*pi\^0$||'; }
comment() { # comment COMMAND WITH ITS FLAGS
  case $(sed -n 1p "$file") in
    "(* kickdrift $1 --certificate "*) ;;
    *) echo "$file:1: the comment is not of the theorem's input, which is $1"; exit 1 ;;
  esac
}

line 2 'From Coq Require Import Reals QArith\.'
line 4 ''
if [ "$(sed -n 3p "$file")" = 'From Kickdrift Require Import Vocabulary EdgeCertificate.' ]; then
  line 1 "\\(\\* kickdrift tongues --ratio $int/$int --rho $rat --m $int --certificate $name \\*\\)"
  line 5 '\(\*\* entry, p, q, rho, and the ends of an interval of s = h1\^2 lambda1 that holds a zero of the entry\. \*\)'
  m=$(sed -n 1p "$file" | sed -E 's/.* --m ([0-9]+) .*/\1/')
  at=6
  for edge in lower upper; do
    [ $edge = upper ] && [ "$(wc -l < "$file")" -eq 9 ] && break   # the last tongue has no upper edge
    line $at "Theorem kickdrift_$edge :"
    line $((at + 1)) "  edge [ABCD] $int $int $frac_R $frac_R $frac_R\\."
    line $((at + 2)) "Proof\\. certify_edge $frac_Q $frac_Q $frac_Q\\. Qed\\."
    line $((at + 3)) "Print Assumptions kickdrift_$edge\\."
    set -- $(sed -n "$((at + 1))p" "$file") # edge X p q ...
    comment "tongues --ratio $3/$4 --rho $(numbers $((at + 1)) | head -1) --m $m"
    at=$((at + 4))
  done
  lines $((at - 1))
elif [ "$(sed -n 3p "$file")" = 'From Kickdrift Require Import Vocabulary WordCertificate.' ]; then
  force='(All|First|Second)'
  letter="(K $force \\[-?$int # $int(; -?$int # $int)*\\]|D $frac_Q|C $force $frac_Q)"
  line 1 "\\(\\* kickdrift word \"[-KDC0-9/(), ]+\" --lambda1 $rat( --lambda2 $rat)? --h $rat --certificate $name \\*\\)"
  line 5 '\(\*\* kind, the letters, then h, lambda1, lambda2\. \*\)'
  line 6 'Theorem kickdrift_word :'
  line 7 "  word_verdict $kind \\[$letter(; $letter)*\\]( $frac_R){3}\\."
  line 8 "Proof\\. certify_word( $frac_Q){3}\\. Qed\\."
  line 9 'Print Assumptions kickdrift_word\.'
  # The letters as the comment writes them: K All [2 # 3; -1 # 36] is K(2/3, -1/36).
  word=$(sed -nE "7s@^  word_verdict $kind \\[(.*)\\]( $frac_R){3}\\.\$@\\4@p" "$file" | sed -E '
    s/([KDC]) ?(All|First|Second)? [[(]([^])]*)[])]/\1\2(\3)/g
    s/All//g; s/First/1/g; s/Second/2/g; s/\); /) /g; s/; /, /g; s| # |/|g; s|/1([,)])|\1|g')
  set -- $(numbers 7)
  second=
  [ "$3" = 0 ] || second=" --lambda2 $3"
  comment "word \"$word\" --lambda1 $2$second --h $1"
  lines 9
else
  line 1 "\\(\\* kickdrift verdict --lambda1 $rat --lambda2 $rat --h1 $rat --h2 $rat --certificate $name \\*\\)"
  line 3 'From Kickdrift Require Import Vocabulary (Pi)?Certificate\.'
  line 5 '\(\*\* kind, p, q with h2/h1 = p/q, then h1, lambda1, h2, lambda2\. \*\)'
  line 6 'Theorem kickdrift_verdict :'
  line 7 "  verdict $kind $int $int( $frac_R| $pi_R){4}\\."
  line 8 "Proof\\. certify(_pi)?( $frac_Q| $pi_Q){4}\\. Qed\\."
  line 9 'Print Assumptions kickdrift_verdict\.'
  set -- $(numbers 7)
  comment "verdict --lambda1 $2 --lambda2 $4 --h1 $1 --h2 $3"
  lines 9
fi

[ -e "$here/Certificate.vo" ] || { echo "the theory is not compiled: run 'make theory' in $here first"; exit 1; }
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cp "$file" "$work/" || exit 1
coqc -q -R "$here" Kickdrift "$work/$(basename "$file")" > "$work/out" || { echo "$file: Coq refuses it"; exit 1; }
"$here/tools/axioms.sh" "$work/out" || exit 1
echo "proven: $file: $(grep -E '^  (verdict|edge|word_verdict)' "$file" | sed 's/^ *//' | tr '\n' ' ')"
