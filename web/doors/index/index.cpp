#include "web/doors/index/index.h"

#include <algorithm>
#include <map>

#include "stormcellar/base/version.h"
#include "web/data/grids/text_answer.h"
#include "web/doors/index/index_files.h"

namespace stormcellar::web {
namespace {

// Returns true if a condition such as "/api/v1 !/zarr" holds: the server has every door that is
// named without "!", and none that is named with "!". (A door answers the requests below one path.)
bool holds(std::string_view condition, const std::vector<std::string>& doors) {
    while (!condition.empty()) {
        std::string_view door = condition.substr(0, condition.find(' '));
        condition.remove_prefix(std::min(door.size() + 1, condition.size()));
        const bool is_wanted = !door.starts_with('!');
        if (!is_wanted) door.remove_prefix(1);
        if ((std::ranges::find(doors, door) != doors.end()) != is_wanted) return false;
    }
    return true;
}

// Returns the page without the parts whose condition does not hold. Removes the conditions.
std::string parts_for(const std::vector<std::string>& doors, std::string_view page) {
    constexpr std::string_view begin = "<!--", end = "-->", word_if = "if ";
    std::string text;
    std::vector<bool> is_shown{true};
    while (true) {
        const std::size_t at = page.find(begin);
        if (is_shown.back()) text += page.substr(0, at);
        if (at == std::string_view::npos) return text;
        page.remove_prefix(at + begin.size());
        const std::string_view words = page.substr(0, page.find(end));
        page.remove_prefix(words.size() + end.size());
        if (words.starts_with(word_if)) {
            is_shown.push_back(is_shown.back() && holds(words.substr(word_if.size()), doors));
        } else {
            is_shown.pop_back();
        }
    }
}

// Replaces each name in double braces by its value.
std::string filled(std::string_view page, const std::map<std::string_view, std::string>& values) {
    std::string text;
    while (true) {
        const std::size_t at = page.find("{{");
        text += page.substr(0, at);
        if (at == std::string_view::npos) return text;
        page.remove_prefix(at + 2);
        const std::string_view name = page.substr(0, page.find("}}"));
        page.remove_prefix(name.size() + 2);
        text += xml_escaped(values.at(name));
    }
}

}  // namespace

IndexDoor::IndexDoor(const std::vector<std::string>& doors, std::string bucket)
    : page_(parts_for(doors, index_page())), bucket_(std::move(bucket)) {}

std::optional<Answer> IndexDoor::answer_at_once(const Request& request) {
    if (request.path == "/index.css")
        return text_answer_to(request, "text/css; charset=utf-8", std::string(index_style()));
    if (request.path == "/index.mjs")
        return text_answer_to(request, "text/javascript; charset=utf-8",
                              std::string(index_script()));
    if (request.path != "/") return sentence(404, "There is nothing at this address.");
    const std::string& base = request.base;
    const std::string host = base.substr(base.find("://") + 3);
    const std::string path = host.substr(std::min(host.find('/'), host.size()));
    return text_answer_to(request, "text/html; charset=utf-8",
                          filled(page_, {{"base", base},
                                         {"path", path},
                                         {"host", host},
                                         {"bucket", bucket_},
                                         {"version", std::string(software_version)}}));
}

Answer IndexDoor::answer(const Request& request) {
    return *answer_at_once(request);
}

}  // namespace stormcellar::web
