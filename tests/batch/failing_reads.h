// tests/batch/failing_reads.h -- files whose bytes cannot be read for a while, as on a disk or a
// share that fails.
//
// It takes the place of the C library's read() and pread() in the program that it is linked to.
#pragma once

#include <string>

namespace stormcellar::testing {

// While this exists, reading the file whose path ends so fails with EIO.
class FailingReads {
  public:
    explicit FailingReads(std::string ending);
    FailingReads(const FailingReads&) = delete;
    FailingReads& operator=(const FailingReads&) = delete;
    ~FailingReads();
};

}  // namespace stormcellar::testing
