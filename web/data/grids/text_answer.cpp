#include "web/data/grids/text_answer.h"

#include <utility>

#include <fmt/format.h>

#include "base/checksum.h"
#include "web/data/grids/compressed.h"

namespace stormcellar::web {

Answer text_answer_to(const Request& request, std::string content_type, std::string text,
                      Fields headers) {
    const Coding coding =
        text.size() < least_compressed_text ? Coding::identity : coding_for(request);
    Entity entity;
    entity.content_type = std::move(content_type);
    entity.etag = fmt::format("\"{:016x}{}{}\"", xxh3_64(std::as_bytes(std::span(text))),
                              coding == Coding::identity ? "" : "-", coding_name(coding));
    entity.coding = coding_name(coding);
    entity.varies = true;
    entity.headers = std::move(headers);
    // A client that already has this text needs no compressed text.
    if (request.header("If-None-Match")) {
        if (Answer unchanged = answer_with(request, entity); unchanged.status == 304)
            return unchanged;
    }
    auto sent = compressed(text, coding);
    if (!sent) return json_error(sent.error());
    entity.bytes = {text_of(std::move(*sent))};
    return answer_with(request, std::move(entity));
}

}  // namespace stormcellar::web
