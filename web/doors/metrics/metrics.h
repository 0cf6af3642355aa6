// web/doors/metrics/metrics.h -- /metrics: the server's counters and gauges for Prometheus
// (docs/web/metrics.md).
//
// Threads   Many threads may use it.
// Errors    404 below the path.
#pragma once

#include <memory>

#include "web/http/counters.h"
#include "web/http/door.h"

namespace stormcellar::web {

class MetricsDoor final : public Door {
  public:
    explicit MetricsDoor(std::shared_ptr<const Counters> counters)
        : counters_(std::move(counters)) {}
    Answer answer(const Request& request) override;

  private:
    const std::shared_ptr<const Counters> counters_;
};

}  // namespace stormcellar::web
