#!/bin/sh
# guards.sh: the checks themselves are checked: each must refuse a tree, a listing or a certificate that is broken.
here=$(cd "$(dirname "$0")/.." && pwd)
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

fresh() { rm -rf "$work/p"; mkdir "$work/p"; (cd "$here" && cp -r *.v _CoqProject certificates tools "$work/p"); }
refuse() { # refuse WHAT COMMAND...
  what=$1; shift
  if "$@" > "$work/out" 2>&1; then echo "guards: NOT refused: $what"; exit 1; fi
}

fresh; "$work/p/tools/holes.sh" "$work/p" || exit 1
fresh; printf 'Lemma x : False.\nAdmitted.\n' >> "$work/p/Cone.v"
refuse "an unfinished proof" "$work/p/tools/holes.sh" "$work/p"
fresh; echo 'Axiom x : False.' >> "$work/p/Algebra.v"
refuse "an axiom" "$work/p/tools/holes.sh" "$work/p"
fresh; echo 'Axiom x : False.' >> "$work/p/certificates/elliptic.v"
refuse "an axiom in a certificate" "$work/p/tools/holes.sh" "$work/p"
fresh; echo 'Lemma x : False. Proof. Abort.' >> "$work/p/MatrixAssumptions.v"
refuse "a listing that does not only print" "$work/p/tools/holes.sh" "$work/p"
fresh; echo '(* stray *)' > "$work/p/Stray.v"
refuse "a file that the build does not know" "$work/p/tools/holes.sh" "$work/p"
fresh; rm "$work/p/Respa.v"
refuse "a missing file" "$work/p/tools/holes.sh" "$work/p"

printf 'Axioms:\nStray.oracle : False\n' > "$work/listing"
refuse "a foreign axiom" "$here/tools/axioms.sh" "$work/listing"
: > "$work/listing"
refuse "an empty listing" "$here/tools/axioms.sh" "$work/listing"
sed '/cone_chain/d' "$here/Assumptions.v" > "$work/short.v"
refuse "a theorem that is not listed" "$here/tools/listed.sh" "$here/Main.v" "$work/short.v"
sed '/one_definite/d' "$here/MatrixAssumptions.v" > "$work/short.v"
refuse "a theorem on matrices that is not listed" "$here/tools/listed.sh" "$here/MatrixSigns.v" "$work/short.v"

sed 's/^Theorem/Notation verdict := (fun _ _ _ _ _ _ _ => True).\n&/' "$here/certificates/elliptic.v" > "$work/meaning.v"
refuse "a certificate that redefines its words" "$here/tools/certificate.sh" "$work/meaning.v"
sed '1s/--h1 [^ ]*/--h1 77/' "$here/certificates/elliptic.v" > "$work/comment.v"
refuse "a comment of another input" "$here/tools/certificate.sh" "$work/comment.v"
grep -q "not of the theorem's input" "$work/out" || { cat "$work/out"; exit 1; }
fresh
refuse "a certificate without the theory" "$work/p/tools/certificate.sh" "$work/p/certificates/elliptic.v"
grep -q "make theory" "$work/out" || { cat "$work/out"; exit 1; }
echo "guards: every broken input was refused"
