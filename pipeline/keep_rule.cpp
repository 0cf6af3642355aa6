#include "pipeline/keep_rule.h"

#include <system_error>

namespace stormcellar::pipeline {

std::optional<std::string> reason_to_keep(const std::filesystem::path& path,
                                          const cache::GridDescription& made) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) return std::nullopt;
    const auto file = cache::GridFile::open(path);
    if (!file) return std::nullopt;
    const auto& stands = file->description();
    if (stands.spec != made.spec || stands.moment != made.moment) return std::nullopt;
    const auto& old = stands.provenance;
    const bool better = !old.partial && made.provenance.partial;
    const bool worse = old.partial && !made.provenance.partial;
    if (better) return "a grid of the whole volume stands in the cache";
    if (!worse && old.source_modified_ns > made.provenance.source_modified_ns) {
        return "a grid of a newer file of this volume stands in the cache";
    }
    return std::nullopt;
}

}  // namespace stormcellar::pipeline
