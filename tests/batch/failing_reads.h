// tests/batch/failing_reads.h -- makes files unreadable for a while, as on a failing disk or share.
//
// failing_reads.cpp replaces the C library's read() and pread() in the program that links it.
#pragma once

#include <string>

namespace stormcellar::testing {

// While this object exists, reading a file whose path ends with `ending` fails with EIO.
class FailingReads {
  public:
    explicit FailingReads(std::string ending);
    FailingReads(const FailingReads&) = delete;
    FailingReads& operator=(const FailingReads&) = delete;
    ~FailingReads();
};

}  // namespace stormcellar::testing
