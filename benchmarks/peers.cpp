// GSL and Boost on arguments from a file: `peers gsl|boost COUNT FILE` reads COUNT u and
// COUNT m, prints the nanoseconds an element takes, and writes sn, cn, dn beside them.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>
#ifdef WITH_GSL
#include <gsl/gsl_sf_elljac.h>
#else
#include <boost/math/special_functions/jacobi_elliptic.hpp>
#endif

int main(int, char **arguments) {
    const std::size_t count = std::strtoull(arguments[1], nullptr, 10);
    const std::string name = arguments[2];
    std::vector<double> in(2 * count), out(3 * count);
    std::FILE *file = std::fopen(name.c_str(), "rb");
    if (!file || std::fread(in.data(), 8, in.size(), file) != in.size()) return 1;
    std::fclose(file);
    const double *u = in.data(), *m = u + count;
    double *sn = out.data(), *cn = sn + count, *dn = cn + count;
    double best = 1e300;
    for (int round = 0; round < 5; ++round) {
        const auto start = std::chrono::steady_clock::now();
        for (std::size_t i = 0; i < count; ++i) {
#ifdef WITH_GSL
            gsl_sf_elljac_e(u[i], m[i], sn + i, cn + i, dn + i);
#else
            sn[i] = boost::math::jacobi_elliptic(std::sqrt(m[i]), u[i], cn + i, dn + i);
#endif
        }
        const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - start;
        if (spent.count() / count < best) best = spent.count() / count;
    }
    std::printf("%.17g\n", best);
    file = std::fopen((name + ".out").c_str(), "wb");
    if (!file || std::fwrite(out.data(), 8, out.size(), file) != out.size()) return 1;
    std::fclose(file);
}
