// GSL or Boost on arrays, one core: every function takes COUNT elements of each column of `in`
// and writes its columns to `out`.  Both take the modulus k = √m.
#include <cmath>
#include <limits>
#ifdef WITH_GSL
#include <gsl/gsl_errno.h>
#include <gsl/gsl_sf_elljac.h>
#include <gsl/gsl_sf_ellint.h>
#else
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <boost/math/special_functions/ellint_3.hpp>
#include <boost/math/special_functions/jacobi_elliptic.hpp>
#endif

using In = const double *const *;
using Out = double *const *;
const double NONE = std::numeric_limits<double>::quiet_NaN();

// NaN where the library gives an error.
template <class F> void each(long count, double *out, F value) {
    for (long i = 0; i < count; ++i) {
#ifdef WITH_GSL
        gsl_sf_result result;
        out[i] = value(i, &result) ? NONE : result.val;
#else
        try {
            out[i] = value(i);
        } catch (...) {
            out[i] = NONE;
        }
#endif
    }
}

extern "C" {
#ifdef WITH_GSL
void prepare() { gsl_set_error_handler_off(); }
void ellipj(long count, In in, Out out) {
    for (long i = 0; i < count; ++i)
        if (gsl_sf_elljac_e(in[0][i], in[1][i], out[0] + i, out[1] + i, out[2] + i))
            out[0][i] = NONE;
}
void ellipk(long count, In in, Out out) {
    each(count, out[0], [=](long i, gsl_sf_result *result) {
        return gsl_sf_ellint_Kcomp_e(std::sqrt(in[0][i]), GSL_PREC_DOUBLE, result);
    });
}
void ellipkinc(long count, In in, Out out) {
    each(count, out[0], [=](long i, gsl_sf_result *result) {
        return gsl_sf_ellint_F_e(in[0][i], std::sqrt(in[1][i]), GSL_PREC_DOUBLE, result);
    });
}
void ellipeinc(long count, In in, Out out) {
    each(count, out[0], [=](long i, gsl_sf_result *result) {
        return gsl_sf_ellint_E_e(in[0][i], std::sqrt(in[1][i]), GSL_PREC_DOUBLE, result);
    });
}
#else
namespace bm = boost::math;
void prepare() {}
void ellipj(long count, In in, Out out) {
    each(count, out[0], [=](long i) {
        return bm::jacobi_elliptic(std::sqrt(in[1][i]), in[0][i], out[1] + i, out[2] + i);
    });
}
void ellipk(long count, In in, Out out) {
    each(count, out[0], [=](long i) { return bm::ellint_1(std::sqrt(in[0][i])); });
}
void ellipkinc(long count, In in, Out out) {
    each(count, out[0], [=](long i) { return bm::ellint_1(std::sqrt(in[1][i]), in[0][i]); });
}
void ellipeinc(long count, In in, Out out) {
    each(count, out[0], [=](long i) { return bm::ellint_2(std::sqrt(in[1][i]), in[0][i]); });
}
void ellippi(long count, In in, Out out) {
    each(count, out[0], [=](long i) { return bm::ellint_3(std::sqrt(in[1][i]), in[0][i]); });
}
void ellippiinc(long count, In in, Out out) {
    each(count, out[0],
         [=](long i) { return bm::ellint_3(std::sqrt(in[2][i]), in[0][i], in[1][i]); });
}
#endif
}
