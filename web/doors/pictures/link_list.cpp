#include "web/doors/pictures/link_list.h"

#include <utility>

#include <fmt/format.h>

#include "web/data/grids/text_answer.h"

namespace stormcellar::web {
namespace {

std::string link_list_html(const LinkList& list) {
    const std::string title = xml_escaped(list.title);
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta "
        "charset=\"utf-8\"><title>{0}</title></head>\n"
        "<body><h1>{0}</h1>\n<pre>\n",
        title);
    for (const Link& link : list.links) {
        html +=
            fmt::format("<a href=\"{}\">{}</a>", xml_escaped(link.address), xml_escaped(link.text));
        if (link.modified) html += "  " + format_utc(*link.modified);
        if (link.size_bytes) html += fmt::format("  {}", *link.size_bytes);
        html += "\n";
    }
    return html + "</pre></body></html>\n";
}

}  // namespace

Answer list_answer_to(const Request& request, std::string json,
                      const std::function<LinkList()>& page) {
    const Fields varies{{"Vary", "Accept"}};
    if (!request.prefers_html())
        return text_answer_to(request, "application/json", std::move(json), varies);
    return text_answer_to(request, "text/html; charset=utf-8", link_list_html(page()), varies);
}

}  // namespace stormcellar::web
