#include "web/doors/pictures/loops.h"

#include <array>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "base/beneath.h"
#include "stormcellar/base/descriptor.h"
#include "web/doors/pictures/link_list.h"

namespace stormcellar::web {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// Media types of the formats of loops (stormcellar/render/animation.h), by ending.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> types_of_loops = {
    {{".webp", "image/webp"},
     {".gif", "image/gif"},
     {".apng", "image/apng"},
     {".mp4", "video/mp4"},
     {".webm", "video/webm"}}};

std::string type_of_loop(const fs::path& file) {
    const std::string ending = file.extension();
    for (const auto& [known, type] : types_of_loops)
        if (known == ending) return std::string(type);
    return "application/octet-stream";
}

std::string name_of_loop(const ServedLoop& loop, const fs::path& file) {
    return loop.name + file.extension().native();
}

UtcTime time_of_change(const struct stat& facts) {
    return UtcTime{std::chrono::milliseconds{std::int64_t{facts.st_mtim.tv_sec} * 1000 +
                                             facts.st_mtim.tv_nsec / 1'000'000}};
}

// Returns an ETag that is made from the file's inode, time and size.
std::string tag_of_loop(const struct stat& facts) {
    return fmt::format("\"{:x}-{:x}-{:x}.{:x}\"", facts.st_ino, facts.st_size, facts.st_mtim.tv_sec,
                       facts.st_mtim.tv_nsec);
}

}  // namespace

std::optional<fs::path> LoopsDoor::file_named(std::string_view name) const {
    for (const ServedLoop& loop : loops_)
        for (const fs::path& file : loop.files)
            if (name_of_loop(loop, file) == name) return file;
    return std::nullopt;
}

Answer LoopsDoor::answer(const Request& request) {
    const auto path = segments_of(request.path);
    if (path.size() == 1) return index(request);
    const auto file = path.size() == 2 ? file_named(path[1]) : std::nullopt;
    if (!file) return sentence(404, "There is no such loop; /loops lists those that there are.");
    const auto opened = open_beneath({}, *file);
    if (!opened && opened.error().code == ErrorCode::not_found)
        return sentence(404, "This loop has not been made yet.");
    if (!opened) return come_back(std::chrono::seconds{5}, "This loop cannot be read now.");
    auto descriptor = std::make_shared<const Descriptor>(*opened);
    struct stat facts {};
    if (::fstat(descriptor->number(), &facts) != 0)
        return come_back(std::chrono::seconds{5}, "This loop cannot be read now.");
    Entity entity;
    entity.content_type = type_of_loop(*file);
    entity.etag = tag_of_loop(facts);
    entity.modified = time_of_change(facts);
    entity.bytes = {FileSlice{std::move(descriptor), 0, static_cast<std::uint64_t>(facts.st_size)}};
    return answer_with(request, std::move(entity));
}

Answer LoopsDoor::index(const Request& request) const {
    ordered_json loops = ordered_json::array();
    std::vector<Link> links;
    for (const ServedLoop& loop : loops_) {
        ordered_json files = ordered_json::array();
        for (const fs::path& file : loop.files) {
            const auto facts = look_beneath({}, file);
            // If several files have the same name and format, serve only the first.
            if (!facts || file_named(name_of_loop(loop, file)) != file) continue;
            const std::string name = name_of_loop(loop, file);
            const std::string url = fmt::format("{}/loops/{}", request.base, encoded(name));
            links.push_back(
                {url, name, static_cast<std::uint64_t>(facts->st_size), time_of_change(*facts)});
            files.push_back({{"url", url},
                             {"media_type", type_of_loop(file)},
                             {"bytes", static_cast<std::uint64_t>(facts->st_size)},
                             {"modified", format_utc(time_of_change(*facts))}});
        }
        loops.push_back({{"loop", loop.name}, {"files", std::move(files)}});
    }
    const ordered_json document = {{"loops", std::move(loops)}};
    return list_answer_to(
        request, document.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n", [&] {
            return LinkList{"Loops", std::move(links)};
        });
}

}  // namespace stormcellar::web
