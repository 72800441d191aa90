#!/usr/bin/env bash
# Every table and every equation that the program writes as LaTeX, in an article of one column and in one of two: pdflatex
# compiles it, no box is too wide, no float too tall, no label comes twice.
#
#   tests/latex.sh PROGRAM [FOLDER]     (which keeps the pages to be looked at)
#
# needs pdflatex with amsmath, booktabs and longtable: Debian's texlive-latex-recommended.
set -euo pipefail
cd "$(dirname "$0")/.."
program=$(realpath "${1:?name the program}")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

n=0
while read -r line; do
    n=$((n + 1))
    # The commands hold neither blanks within words nor quotes.
    # shellcheck disable=SC2086
    "$program" $line --quiet --format latex > "$scratch/$(printf %02d $n).tex"
done <<'LINES'
verdict --lambda1 10 --lambda2 2/5 --h1 0.631 --h2 3.499
verdict --lambda1 pi^2 --lambda2 pi^2/25 --h1 2/7 --h2 2
verdict --lambda1 11/4 --lambda2 57/10 --h1 1 --h2 5/3 --columns kind,stable,side,trace,decided_by
curves --samples 12
curves --a 0..0 --b 1..1 --samples 9 --digits 5
compare --max-sum 9 --rho 1/25 --samples 20
compare --lambda1 10 --lambda2 2/5 --step 1/10 --h1-range 1/10..3/5 --h2-range 1/10..7/2 --digits 4
compare --max-sum 7 --rho 1/25 --samples 9 --columns s,rho,kind,tan,distance
proposition --max 5
proposition --max 9
polynomial --ratio 5/3
polynomial --ratio 13/8
polynomial --ratio 9/1
map --lambda1 pi^2 --lambda2 pi^2/25 --step 1/20 --h1-range 1/20..2/pi --h2-range 1/20..7/2
map --lambda1 pi^2 --lambda2 pi^2/25 --step 1/10 --h1-range 1/10..2/pi --h2-range 1/10..7/2 --label --growth
tongues --ratio 7/3 --rho 1/25
tongues --ratio 7/3 --rho 1/25 --digits 4
tongues --ratio 7/3 --rho 1/25 --digits 30 --columns edges --m 3..5
tongues --ratio 7/3 --rho 1/25 --columns exact,growth,predicted,first-order
tongues --ratio 5/3 --rho 114/55 --lambda1 pi^2 --columns exact
tongues --max-sum 13 --rho 1/25
tongues --max-sum 8 --rho 1/1000 --columns predicted,first-order
tongues --survey --max-sum 30 --rho 1/25
closings --max-sum 9
closings --ratio 5/4 --digits 20
verdict --lambda1 10 --lambda2 2/5 --h1 0.631 --h2 3.499 --columns h1,h2,p,q,kind,stable,side,trace,growth_rate,m,a,b --digits 12
system data/scenes/three-clocks.json
system data/scenes/bar-resonant.json
system data/scenes/diatomic-tether.json --columns part,decided_by,mu_re,mu_im,radius,growth_rate
system data/scenes/diatomic-tether.json --scan potentials.1.step=1/10..1/2:1/10 --scan potentials.1.scale=1..2:1/2
system data/scenes/water4.json --intervals outer=0.0043..0.0045 --resolution 1e-3
simulate data/scenes/fpu.json --periods 30
simulate data/scenes/fpu.json --periods 60
advise --period OH=10fs --period slow=40fs --steps 0.5fs,4fs --steps 0.5fs,5fs
LINES

article() {
    local options=$1 name=$2
    {
        echo "\\documentclass[a4paper$options]{article}"
        echo '\usepackage{amsmath,booktabs,longtable}'
        echo '\begin{document}'
        for table in "$scratch"/[0-9]*.tex; do
            echo "\\input{$(basename "$table")}"
            # Many floats in a row with no text between.
            echo '\clearpage'
        done
        echo '\end{document}'
    } > "$scratch/$name.tex"
    # Twice: widths of long tables and labels come from the first run.
    for _ in 1 2; do
        (cd "$scratch" && pdflatex -halt-on-error -interaction=nonstopmode "$name.tex" > "$name.out") || {
            grep -A12 '^!' "$scratch/$name.out"
            return 1
        }
    done
    if grep -E -A3 'Overfull|too large|multiply.defined|undefined|Too many' "$scratch/$name.log"; then
        return 1
    fi
    echo "$name: $(grep -o 'Output written.*pages' "$scratch/$name.log")"
}

article "" one
article ",twocolumn" two
if [ -n "${2:-}" ]; then cp "$scratch"/*.pdf "$scratch"/[0-9]*.tex "$2"; fi
