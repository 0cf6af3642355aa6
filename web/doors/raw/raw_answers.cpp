#include "web/doors/raw/raw_answers.h"

namespace stormcellar::web {
namespace {

constexpr std::chrono::seconds settled_holds_for{60}, cataloged_again_in{5};

// Makes the entity. If the requested name is only the beginning of the file's name, clients are
// told to save the volume under the whole name, because its ending tells how it is packed.
Entity entity_of(const OpenedVolume& volume, std::string_view asked_for) {
    Entity entity = entity_of(volume);
    const std::string& name = volume.volume.name;
    if (name != asked_for && name.starts_with(asked_for)) {
        entity.headers.emplace_back("Content-Disposition",
                                    fmt::format("attachment; filename=\"{}\"", name));
    }
    return entity;
}

}  // namespace

Entity entity_of(const OpenedVolume& volume) {
    Entity entity;
    entity.bytes = volume.bytes;
    entity.content_type = "application/octet-stream";
    entity.etag = volume.volume.tag;
    entity.modified = volume.volume.modified;
    if (!volume.volume.grows) entity.max_age = settled_holds_for;
    return entity;
}

Answer missing_answer(const RawFailure& failure) {
    switch (failure.why) {
        case RawMissing::gone:
            return sentence(410, "This volume was here; its file has been deleted.");
        case RawMissing::changed:
            return come_back(cataloged_again_in,
                             "The file of this volume has changed and is not yet cataloged again.");
        case RawMissing::trouble:
            return come_back(cataloged_again_in, "The file of this volume cannot be read now.");
        case RawMissing::unknown:
            break;
    }
    return sentence(404, "There is no such volume.");
}

Answer volume_answer(const Request& request, RawFiles& files, std::string_view station,
                     std::string_view name) {
    const auto opened = files.open(station, name);
    if (!opened) return missing_answer(opened.error());
    return answer_with(request, entity_of(*opened, name));
}

std::optional<Answer> volume_answer_at_once(const Request& request, RawFiles& files,
                                            std::string_view station, std::string_view name) {
    const auto opened = files.open_kept(station, name);
    if (!opened) return std::nullopt;
    return answer_with(request, entity_of(*opened, name));
}

std::optional<Answer> named_volume_at_once(const Request& request, RawFiles& files) {
    const auto segments = segments_of(request.path);
    if (segments.size() != 3 || request.path.ends_with('/')) return std::nullopt;
    return volume_answer_at_once(request, files, segments[1], segments[2]);
}

Result<UtcTime> time_of_parameter(std::string_view text, UtcTime now) {
    if (text == "present") return now;
    // In a query, an unencoded '+' has become a space.
    for (const std::string_view zone : {"+00:00", " 00:00", "+0000", " 0000"})
        if (text.size() > zone.size() && text.ends_with(zone)) text.remove_suffix(zone.size());
    return parse_utc(text, now);
}

}  // namespace stormcellar::web
