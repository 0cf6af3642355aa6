#include "web/doors/viewer/viewer.h"

#include <algorithm>
#include <array>
#include <map>

#include "base/checksum.h"
#include "stormcellar/base/mutex.h"
#include "web/data/grids/compressed.h"
#include "web/doors/viewer/viewer_files.h"
#include "web/http/answer.h"

namespace stormcellar::web {
namespace {

constexpr std::string_view page_name = "index.html";

// Returns the file in the coding. Each file is compressed once for each coding.
std::optional<Text> file_in_coding(const ViewerFile& file, Coding coding) {
    static Mutex mutex;
    static std::map<std::pair<std::string_view, Coding>, Text> kept STORMCELLAR_GUARDED_BY(mutex);
    const MutexLock lock(mutex);
    const auto found = kept.find({file.name, coding});
    if (found != kept.end()) return found->second;
    auto bytes = compressed_once(file.bytes, coding);
    if (!bytes) return std::nullopt;
    return kept.emplace(std::pair{file.name, coding}, text_of(std::move(*bytes))).first->second;
}

Answer file_answer(const Request& request, const ViewerFile& file) {
    const Coding coding = coding_for(request);
    const auto bytes = file_in_coding(file, coding);
    if (!bytes) return sentence(503, "There is no memory for this now.");
    Entity entity;
    entity.bytes = {*bytes};
    entity.content_type = file.media_type;
    entity.coding = coding_name(coding);
    entity.varies = true;
    entity.etag = fmt::format("\"{:016x}-{}\"", xxh3_64(std::as_bytes(std::span(file.bytes))),
                              coding_name(coding));
    return answer_with(request, std::move(entity));
}

}  // namespace

std::optional<Answer> ViewerDoor::answer_at_once(const Request& request) {
    const auto path = segments_of(request.path);
    const bool is_folder = path.size() == 1;
    if (is_folder && !request.path.ends_with('/')) return moved_to(request, "/view/");
    const std::string_view name = path.size() < 2 ? page_name : std::string_view(path[1]);
    const auto files = viewer_files();
    const auto file = std::ranges::find(files, name, &ViewerFile::name);
    const bool is_file = is_folder || (path.size() == 2 && !request.path.ends_with('/'));
    if (!is_file || file == files.end()) {
        return sentence(404, files.empty() ? "This server was built without the viewer."
                                           : "The viewer has no such file.");
    }
    return file_answer(request, *file);
}

Answer ViewerDoor::answer(const Request& request) {
    return *answer_at_once(request);
}

}  // namespace stormcellar::web
