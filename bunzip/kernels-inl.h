// bunzip/kernels-inl.h -- one of a kernel's forms by the path that is taken.
//
// Included after hwy/highway.h, outside of the targets' namespaces.
// NOLINTBEGIN(llvm-header-guard)
#ifndef STORMCELLAR_BUNZIP_KERNELS_INL_H
#define STORMCELLAR_BUNZIP_KERNELS_INL_H

#include <hwy/highway.h>

#include "bunzip/paths.h"

// The kernel of that name as it was compiled for AVX2 or AVX-512; null where it was not.
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

// A kernel's forms, pointers to functions. The path is one that this machine has; where it has no
// form of its own, the plain one is taken.
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
