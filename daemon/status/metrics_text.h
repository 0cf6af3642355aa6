// daemon/status/metrics_text.h -- the status as Prometheus metrics; docs/reference/metrics.md
// explains each metric.
//
// Names begin with stormcellar_ and end with their unit; names of counters end with _total. Values
// of the labels (station, domain, loop, result, reason, state) are bounded by the configuration, by
// fixed lists, or by the limit of a StationBook. Families without a sample are left out.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <string>

#include "daemon/status/status.h"
#include "service/metrics_writer.h"

namespace stormcellar::daemon {

[[nodiscard]] std::string metrics_text(const StatusFacts& facts, const Pending& pending,
                                       UtcTime now);

}  // namespace stormcellar::daemon
