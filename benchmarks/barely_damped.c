/* The barely damped pendulum step by step, for tests/test_averaged.py: Taylor series of order 26
   in 80-bit arithmetic, ε = 1, to t = 5/β.  Half an hour for β = 1e-8.

       cc -O3 -march=native barely_damped.c -o barely_damped -lm
       ./barely_damped BETA THETA0 V0 COUNT

   prints COUNT rows: t, θ within its turn, v, turns. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define ORDER 26
#define PI 3.141592653589793238462643383279502884L

typedef long double real;

int main(int count, char **words) {
  if (count != 5) return 1;
  real beta = strtod(words[1], NULL), theta = strtod(words[2], NULL), v = strtod(words[3], NULL);
  int rows = atoi(words[4]);
  long long turns = 0;
  real t = 0;
  for (int row = 1; row <= rows; row++) {
    double until = (double)(5.0L / beta * row / rows);
    while (t < until) {
      real a[ORDER + 1], s[ORDER + 1], c[ORDER + 1];
      a[0] = v, s[0] = sinl(theta), c[0] = cosl(theta);
      for (int n = 0; n < ORDER; n++) {
        real ds = 0, dc = 0;
        for (int k = 0; k <= n; k++) ds += a[k] * c[n - k], dc -= a[k] * s[n - k];
        a[n + 1] = (-s[n] - beta * a[n]) / (n + 1);
        s[n + 1] = ds / (n + 1), c[n + 1] = dc / (n + 1);
      }
      real h = 0.35L / (1 + 0.3L * fabsl(v));
      int last = t + h >= until;
      if (last) h = until - t;
      real of_v = a[ORDER], of_theta = a[ORDER - 1] / ORDER;
      for (int n = ORDER - 1; n >= 1; n--) of_v = of_v * h + a[n];
      for (int n = ORDER - 2; n >= 0; n--) of_theta = of_theta * h + a[n] / (n + 1);
      theta += of_theta * h, v += of_v * h;
      t = last ? until : t + h;
      if (theta > PI) theta -= 2 * PI, turns++;
      if (theta < -PI) theta += 2 * PI, turns--;
    }
    printf("%.17g %.18Lg %.18Lg %lld\n", until, theta, v, turns);
    fflush(stdout);
  }
  return 0;
}
