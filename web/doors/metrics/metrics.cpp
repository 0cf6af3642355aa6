#include "web/doors/metrics/metrics.h"

#include "service/metrics_writer.h"

namespace stormcellar::web {

Answer MetricsDoor::answer(const Request& request) {
    if (segments_of(request.path).size() != 1)
        return sentence(404, "There is nothing below /metrics.");
    Answer answer = text_answer(200, std::string(metrics_content_type), counters_->text());
    answer.with("Cache-Control", "no-store");
    return answer;
}

}  // namespace stormcellar::web
