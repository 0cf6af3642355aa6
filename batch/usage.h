// batch/usage.h -- what a task takes of a machine.
//
// Threads   One task at a time in a process.
#pragma once

#include "batch/record.h"

namespace stormcellar::batch {

class Usage {
  public:
    Usage();  // the task begins
    // Writes times, processor seconds, the process's largest memory, and the host.
    void end(Record& record) const;

  private:
    UtcTime started_;
    double cpu_s_;
};

}  // namespace stormcellar::batch
