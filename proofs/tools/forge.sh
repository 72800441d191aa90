#!/bin/sh
# forge.sh FILE.v: claim each of the other six kinds in FILE's place; every forgery must be refused.
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
own=$(sed -nE 's/^  verdict (Elliptic|\([A-Za-z ]+\)) .*/\1/p' "$1")
for kind in Elliptic '(Hyperbolic Plus)' '(Hyperbolic Minus)' '(Parabolic Plus)' '(Parabolic Minus)' \
            '(Coexistence Plus)' '(Coexistence Minus)'; do
  [ "$kind" = "$own" ] && continue
  sed "s/^  verdict $own /  verdict $kind /" "$1" > "$work/forged.v"
  cmp -s "$1" "$work/forged.v" && { echo "forge: $1 was not changed"; exit 1; }
  if "$here/certificate.sh" "$work/forged.v" > "$work/out" 2>&1; then
    echo "ACCEPTED, but forged: $1 as $kind"; exit 1
  fi
  grep -q 'Coq refuses it' "$work/out" || { cat "$work/out"; exit 1; }
done
echo "refused, as it must be: $1 under each of the other six kinds"
