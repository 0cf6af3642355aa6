// bunzip/targets-inl.h -- chooses the Highway targets for which the kernels are compiled.
//
// Include it before hwy/foreach_target.h. The plain path is C++ outside the targets, so targets
// below AVX2 are not needed. NOLINTBEGIN(llvm-header-guard)
#ifndef STORMCELLAR_BUNZIP_TARGETS_INL_H
#define STORMCELLAR_BUNZIP_TARGETS_INL_H

#define HWY_WANT_AVX3_DL
#ifndef HWY_DISABLED_TARGETS  // a build may disable more
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3)
#endif

#endif
// NOLINTEND(llvm-header-guard)
