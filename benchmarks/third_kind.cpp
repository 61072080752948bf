// Boost's integrals of the third kind on arguments from a file: `third_kind COUNT FILE` reads
// COUNT each of n (φ) m, prints the nanoseconds an element takes, and writes Π beside them.
#include <boost/math/special_functions/ellint_3.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

int main(int, char **arguments) {
    const std::size_t count = std::strtoull(arguments[1], nullptr, 10);
    const std::string name = arguments[2];
    std::vector<double> in(COLUMNS * count), out(count);
    std::FILE *file = std::fopen(name.c_str(), "rb");
    if (!file || std::fread(in.data(), 8, in.size(), file) != in.size()) return 1;
    std::fclose(file);
    const double *n = in.data(), *m = n + (COLUMNS - 1) * count;
    double best = 1e300;
    for (int round = 0; round < 3; ++round) {
        const auto start = std::chrono::steady_clock::now();
        for (std::size_t i = 0; i < count; ++i) {
#if COLUMNS == 3
            out[i] = boost::math::ellint_3(std::sqrt(m[i]), n[i], n[count + i]);
#else
            out[i] = boost::math::ellint_3(std::sqrt(m[i]), n[i]);
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
