/* The propagator over the full period in doubles, kick by kick and drift by drift.
 * Time is counted in units of h1/q = h2/p, so that coincidences are exact.
 */
#ifndef real
#define real double
#endif

static void full_period(long p, long q, real k1, real k2, real tick, real *m) {
    m[0] = m[3] = 1;
    m[1] = m[2] = 0;
    for (long now = 0, next1 = 0, next2 = 0, next; now < p * q; now = next) {
        real k = 0;
        if (next1 == now) { k += k1; next1 += q; }
        if (next2 == now) { k += k2; next2 += p; }
        next = next1 < next2 ? next1 : next2;
        real t = (next - now) * tick;
        m[2] -= k * m[0];
        m[3] -= k * m[1];
        m[0] += t * m[2];
        m[1] += t * m[3];
    }
}

static long gcd(long a, long b) { while (b) { long t = a % b; a = b; b = t; } return a; }

/* Of all pairs h1 = i/n, h2 = j/n. */
void full_periods(double lambda1, double lambda2, long n, long columns, long rows, real *matrices) {
    for (long i = 1; i <= columns; i++)
        for (long j = 1; j <= rows; j++) {
            long g = gcd(i, j);
            double h1 = (double)i / n, h2 = (double)j / n;
            full_period(j / g, i / g, h1 * lambda1, h2 * lambda2, h1 / (i / g), matrices + 4 * ((i - 1) * rows + j - 1));
        }
}

/* Its trace in the unit of time h1, s = h1^2 lambda1, rho = lambda2/lambda1. */
double trace(double s, double rho, long p, long q) {
    real m[4];
    full_period(p, q, s, s * rho * p / q, 1.0 / q, m);
    return m[0] + m[3];
}
