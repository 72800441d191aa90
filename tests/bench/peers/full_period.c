/* The loop that anyone would write: Figure 1 by the product of all kicks and drifts over the whole period.
 *
 * Usage: full_period N [FILE]. Steps h1 = i/N <= 2/pi and h2 = j/N <= 7/2, stiffnesses pi^2 and pi^2/25; unstable iff
 * |trace| > 2 in doubles. Prints the number of pairs, of unstable ones, the seconds that passed, and those of processor time;
 * FILE gets a character 0 or 1 for each pair, h2 running fastest.
 * Time is counted in units of h1/q = h2/p, so that coincidences are exact.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <omp.h>

static long gcd(long a, long b) { while (b) { long t = a % b; a = b; b = t; } return a; }

static int unstable(long i, long j, double d) {
    long g = gcd(i, j), p = j / g, q = i / g;
    double h1 = i * d, h2 = j * d, tick = h1 / q;
    double k1 = h1 * M_PI * M_PI, k2 = h2 * M_PI * M_PI / 25;
    double a = 1, b = 0, c = 0, e = 1; /* [[a, b], [c, e]] */
    long next1 = 0, next2 = 0, now = 0, end = p * q;
    while (now < end) {
        double k = 0;
        if (next1 == now) { k += k1; next1 += q; }
        if (next2 == now) { k += k2; next2 += p; }
        long next = next1 < next2 ? next1 : next2;
        double t = (next - now) * tick;
        c -= k * a; e -= k * b;
        a += t * c; b += t * e;
        now = next;
    }
    return !(fabs(a + e) <= 2);
}

int main(int argc, char **argv) {
    long n = argc > 1 ? atol(argv[1]) : 100;
    long columns = (long)floor(2 / M_PI * n), rows = 7 * n / 2, count = 0;
    double d = 1.0 / n, start = omp_get_wtime();
    char *verdicts = malloc(columns * rows);
    #pragma omp parallel for schedule(dynamic) reduction(+ : count)
    for (long i = 1; i <= columns; i++)
        for (long j = 1; j <= rows; j++)
            count += verdicts[(i - 1) * rows + j - 1] = unstable(i, j, d);
    printf("%ld %ld %.6f %.6f\n", columns * rows, count, omp_get_wtime() - start, (double)clock() / CLOCKS_PER_SEC);
    if (argc > 2) {
        FILE *file = fopen(argv[2], "w");
        for (long k = 0; k < columns * rows; k++) fputc('0' + verdicts[k], file);
        fclose(file);
    }
    free(verdicts);
    return 0;
}
