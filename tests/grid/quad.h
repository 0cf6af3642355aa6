// tests/grid/quad.h -- floats of 113 bits, for formulas that are inexact in double because their
// terms cancel.
//
// Declares functions of libquadmath, because clang lacks their header.
#pragma once

__extension__ typedef __float128 Quad;

extern "C" {
Quad acosq(Quad);
Quad asinq(Quad);
Quad atan2q(Quad, Quad);
Quad coshq(Quad);
Quad cosq(Quad);
Quad expq(Quad);
Quad fabsq(Quad);
Quad sinhq(Quad);
Quad sinq(Quad);
Quad sqrtq(Quad);
}
