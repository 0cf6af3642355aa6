// batch/usage.h -- measures the resources that a task uses.
//
// Threads   One task at a time in a process.
#pragma once

#include "batch/record.h"

namespace stormcellar::batch {

class Usage {
  public:
    Usage();  // starts the measurement
    // Writes the times, the processor seconds, the peak memory of the process, and the host to the
    // record.
    void end(Record& record) const;

  private:
    UtcTime started_;
    double cpu_s_;
};

}  // namespace stormcellar::batch
