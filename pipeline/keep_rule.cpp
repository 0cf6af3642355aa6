#include "pipeline/keep_rule.h"

#include <algorithm>
#include <system_error>

namespace stormcellar::pipeline {
namespace {

bool is_living(const grid::Provenance& provenance) {
    return provenance.partial &&
           std::any_of(provenance.notes.begin(), provenance.notes.end(),
                       [](const std::string& note) { return note.starts_with(living_note); });
}

}  // namespace

std::optional<std::string> reason_to_keep(const std::filesystem::path& path,
                                          const cache::GridDescription& made) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) return std::nullopt;
    const auto file = cache::GridFile::open(path);
    if (!file) return std::nullopt;
    const auto& stands = file->description();
    if (stands.spec != made.spec || stands.moment != made.moment) return std::nullopt;
    const auto& old = stands.provenance;
    const bool stands_living = is_living(old);
    const bool made_living = is_living(made.provenance);
    if (stands_living && !made_living) return std::nullopt;
    if (!stands_living && made_living) return "a grid of the volume's end stands in the cache";
    const bool better = !old.partial && made.provenance.partial;
    const bool worse = old.partial && !made.provenance.partial;
    if (better) return "a grid of the whole volume stands in the cache";
    if (!worse && old.source_modified_ns > made.provenance.source_modified_ns) {
        return "a grid of a newer file of this volume stands in the cache";
    }
    return std::nullopt;
}

}  // namespace stormcellar::pipeline
