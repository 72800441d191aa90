/* What |Tr Q| > 2 calls unstable on Figure 1's window at a spacing of 1/N, and the traces that are no numbers:
 * cc -O2 -ffp-contract=off overflow.c -lm && ./a.out N; singles by -Dreal=float.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "plain.c"

int main(int count, char **words) {
    long n = atol(words[count - 1]), unstable = 0, lost = 0;
    double pi = acos(-1), lambda1 = pi * pi, lambda2 = lambda1 / 25;
    for (long i = 1; i <= n * 2 / pi; i++)
        for (long j = 1; j <= n * 7 / 2; j++) {
            real q[4];
            long g = gcd(i, j);
            double h1 = (double)i / n, h2 = (double)j / n;
            full_period(j / g, i / g, h1 * lambda1, h2 * lambda2, h1 / (i / g), q);
            real trace = q[0] + q[3];
            unstable += fabs(trace) > 2;
            lost += isnan(trace);
        }
    printf("1/%ld: %ld pairs with |Tr Q| > 2, %ld without a trace\n", n, unstable, lost);
}
