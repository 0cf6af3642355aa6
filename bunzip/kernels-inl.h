// bunzip/kernels-inl.h -- chooses the form of a kernel (a function that is compiled for several
// vector units) by the path in use (paths.h).
//
// Include it after hwy/highway.h, outside the namespaces of the targets.
// NOLINTBEGIN(llvm-header-guard)
#ifndef STORMCELLAR_BUNZIP_KERNELS_INL_H
#define STORMCELLAR_BUNZIP_KERNELS_INL_H

#include <hwy/highway.h>

#include "bunzip/paths.h"

// Expands to the kernel of this name compiled for AVX2 or AVX-512, or to null if it is not
// compiled.
#if HWY_TARGETS & HWY_AVX2
#define STORMCELLAR_BUNZIP_AVX2(kernel) N_AVX2::kernel
#else
#define STORMCELLAR_BUNZIP_AVX2(kernel) nullptr
#endif
#if HWY_TARGETS & HWY_AVX3_DL
#define STORMCELLAR_BUNZIP_AVX512(kernel) N_AVX3_DL::kernel
#else
#define STORMCELLAR_BUNZIP_AVX512(kernel) nullptr
#endif

namespace stormcellar::bunzip {

// Pointers to the forms of a kernel. of() returns the form for a path, which this machine must
// support, or the plain form if the path has no form of its own.
template <class Kernel>
struct Kernels {
    Kernel plain;
    Kernel avx2 = nullptr;
    Kernel avx512 = nullptr;

    [[nodiscard]] Kernel of(Path path) const {
        if (path == Path::avx2 && avx2 != nullptr) return avx2;
        if (path == Path::avx512 && avx512 != nullptr) return avx512;
        return plain;
    }
};

}  // namespace stormcellar::bunzip

#endif
// NOLINTEND(llvm-header-guard)
