#include "web/http/common_headers.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace stormcellar::web {
namespace {

// Returns true if a browser may run what is in the answer: pages, scripts, and XML, which may hold
// a page. Browsers do not guess at other types, because of nosniff.
bool may_run(const Answer& answer) {
    const auto type = std::ranges::find(answer.headers, "Content-Type", &Fields::value_type::first);
    if (type == answer.headers.end()) return false;
    return std::ranges::any_of(
        std::to_array<std::string_view>({"html", "javascript", "xml"}),
        [&](std::string_view part) { return type->second.find(part) != std::string::npos; });
}

// Adds headers that forbid browsers all that the server's pages do not need.
void add_headers_of_pages(Answer& answer, const OriginRules& origins) {
    answer.with(
        "Content-Security-Policy",
        fmt::format("default-src 'none'; script-src 'self'; worker-src 'self'; style-src 'self'; "
                    "img-src 'self' data: blob:; connect-src 'self'; font-src 'self'; base-uri "
                    "'none'; frame-ancestors {}; form-action 'none'",
                    origins.embed_in.empty()
                        ? "'none'"
                        : fmt::format("{}", fmt::join(origins.embed_in, " "))));
    answer.with("Cross-Origin-Opener-Policy", "same-origin");
    answer.with("Cross-Origin-Embedder-Policy", "require-corp");
    answer.with("Referrer-Policy", "no-referrer");
}

}  // namespace

void add_common_headers(Answer& answer, const Request& request, const OriginRules& origins) {
    answer.with("X-Content-Type-Options", "nosniff");
    // By this header, the page can tell a refusal of this server from the refusal of a proxy.
    if (answer.status >= 400) answer.with("Stormcellar-Status", std::to_string(answer.status));
    const bool is_page = may_run(answer);
    if (is_page) add_headers_of_pages(answer, origins);
    const bool is_for_others = origins.any_may_read || (is_page && !origins.embed_in.empty());
    answer.with("Cross-Origin-Resource-Policy", is_for_others ? "cross-origin" : "same-origin");
    if (origins.any_may_read) {
        answer.with("Access-Control-Allow-Origin", "*");
        answer.with(
            "Access-Control-Expose-Headers",
            "Accept-Ranges, Content-Length, Content-Range, ETag, Last-Modified, Retry-After");
        if (request.verb == Verb::options) {
            answer.with("Access-Control-Allow-Methods", "GET, HEAD, OPTIONS");
            answer.with("Access-Control-Allow-Headers", "Range, If-None-Match, Last-Event-ID");
            answer.with("Access-Control-Max-Age", "86400");
        }
    }
}

}  // namespace stormcellar::web
