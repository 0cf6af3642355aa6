// tests/batch/failing_reads.h -- makes files unreadable for a while, as on a failing disk or share.
//
// A program that links failing_reads.cpp calls its read() and pread() instead of the C library's.
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
