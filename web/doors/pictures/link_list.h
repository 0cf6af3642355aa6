// web/doors/pictures/link_list.h -- answers with lists as JSON, or as pages of links for browsers
// and for programs that follow links, such as wget -r and rclone.
//
// Threads   Pure functions.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/utc_time.h"
#include "web/http/answer.h"

namespace stormcellar::web {

struct Link {
    std::string address;  // relative to the page, or absolute; a folder's address ends with a slash
    std::string text;
    std::optional<std::uint64_t> size_bytes;
    std::optional<UtcTime> modified;
};
struct LinkList {
    std::string title;
    std::vector<Link> links;
};

// Answers with the JSON, or with the page if the client's Accept prefers HTML.
[[nodiscard]] Answer list_answer_to(const Request& request, std::string json,
                                    const std::function<LinkList()>& page);

}  // namespace stormcellar::web
