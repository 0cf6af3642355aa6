#include "web/http/common_headers.h"

#include <algorithm>
#include <array>
#include <string>

namespace stormcellar::web {
namespace {

// Returns true if a browser treats the answer as data and not as a page or a script. Returns false
// for unknown types.
bool is_data(const Answer& answer) {
    const auto type = std::ranges::find(answer.headers, "Content-Type", &Fields::value_type::first);
    if (type == answer.headers.end()) return false;
    constexpr std::array<std::string_view, 7> types{
        "image/png",           "image/jpeg",       "image/webp",
        "image/tiff",          "application/json", "application/octet-stream",
        "application/x-netcdf"};
    return std::ranges::any_of(types,
                               [&](std::string_view one) { return type->second.starts_with(one); });
}

// Returns headers that forbid browsers all that the server's pages do not need.
const Fields& headers_of_pages() {
    static const Fields headers = {
        {"Content-Security-Policy",
         "default-src 'none'; script-src 'self'; worker-src 'self'; style-src 'self'; img-src "
         "'self' data: blob:; connect-src 'self'; font-src 'self'; base-uri 'none'; "
         "frame-ancestors 'none'; form-action 'none'"},
        {"Cross-Origin-Opener-Policy", "same-origin"},
        {"Cross-Origin-Embedder-Policy", "require-corp"},
        {"Referrer-Policy", "no-referrer"},
    };
    return headers;
}

}  // namespace

void add_common_headers(Answer& answer, const Request& request, bool any_origin) {
    answer.with("X-Content-Type-Options", "nosniff");
    // By this header, the page can tell a refusal of this server from the refusal of a proxy.
    if (answer.status >= 400) answer.with("Stormcellar-Status", std::to_string(answer.status));
    if (!is_data(answer)) {
        for (const auto& [name, value] : headers_of_pages())
            answer.with(name, value);
    }
    answer.with("Cross-Origin-Resource-Policy", any_origin ? "cross-origin" : "same-origin");
    if (any_origin) {
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
