#include "web/data/station/decoded_volumes.h"

#include <span>
#include <utility>

#include <fmt/format.h>

#include "level2/containers/ldm_framer.h"
#include "pipeline/drop/cataloged_volume.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::web {
namespace {

using catalog::CatalogEntry;

constexpr std::size_t volume_header_bytes = 24;

level2::DecodeOptions options_for(const CatalogEntry& entry) {
    level2::DecodeOptions options;
    options.output_limit_bytes = DecodedVolumes::most_volume_bytes;
    options.fallback_station = entry.station;
    return options;
}

Status check_is_cataloged(const level2::Volume& volume, const CatalogEntry& entry) {
    if (volume.start_time() == entry.volume.start_time && volume.vcp == entry.volume.vcp) return {};
    return fail(ErrorCode::corrupt, "{}: holds another volume than the catalog says",
                entry.path.native());
}

std::uint64_t bytes_of_volume(const level2::Volume& volume) {
    std::uint64_t bytes = sizeof volume;
    for (const level2::Sweep& sweep : volume.sweeps) {
        bytes += sweep.radials.size() * sizeof(level2::Radial);
        for (const level2::SweepMoment& array : sweep.moments)
            bytes += array.codes8.size() + 2 * (array.codes16.size() + array.gate_counts.size());
    }
    return bytes;
}

bool has_ldm_records(std::span<const std::byte> bytes) {
    return bytes.size() > volume_header_bytes &&
           level2::is_ldm_record(bytes.subspan(volume_header_bytes));
}

Result<DecodedVolumes::Volume> decode_whole(const VolumeToDecode& wanted) {
    const CatalogEntry& entry = wanted.entry;
    const auto raw = pipeline::read_cataloged_volume(wanted.catalog, entry);
    if (!raw) return pass_on(raw);
    auto decoded = level2::decode(raw->bytes, options_for(entry));
    if (!decoded) return pass_on(decoded);
    auto volumes = level2::split_volumes(std::move(*decoded));
    const auto index = static_cast<std::size_t>(entry.number_in_file) - 1;
    if (index >= volumes.size())
        return fail(ErrorCode::corrupt, "{}: has no volume {}", entry.path.native(),
                    entry.number_in_file);
    if (Status same = check_is_cataloged(volumes[index], entry); !same) return pass_on(same);
    return std::make_shared<const level2::Volume>(std::move(volumes[index]));
}

// If no record was skipped, the whole volume has the same cost and more use.
Result<DecodedVolumes::Volume> decode_cut(const VolumeToDecode& wanted, int elevation_number) {
    const CatalogEntry& entry = wanted.entry;
    const auto raw = pipeline::read_cataloged_volume(wanted.catalog, entry);
    if (!raw) return pass_on(raw);
    if (!has_ldm_records(raw->bytes)) return DecodedVolumes::Volume{};
    level2::DecodeOptions options = options_for(entry);
    options.selection.elevation_numbers = {elevation_number};
    auto decoded = level2::decode(raw->bytes, options);
    if (!decoded) return pass_on(decoded);
    const level2::Volume& volume = decoded->volume;
    const bool is_one = volume.sweeps.size() == 1 && !volume.sweeps.front().radials.empty() &&
                        !volume.sweeps.front().moments.empty();
    if (!is_one || decoded->report.records_skipped == 0) return DecodedVolumes::Volume{};
    if (Status same = check_is_cataloged(volume, entry); !same) return pass_on(same);
    return std::make_shared<const level2::Volume>(std::move(decoded->volume));
}

}  // namespace

Result<std::string> key_of_volume(const catalog::CatalogReader& catalog,
                                  const CatalogEntry& entry) {
    const auto chunks = pipeline::hash_of_growing_rows(catalog, entry);
    if (!chunks) return pass_on(chunks);
    return fmt::format("{}/{}/{:x}/{}/{}/{}/{:x}", entry.path.native(), entry.size_bytes,
                       entry.content_hash, entry.modified_ns, entry.number_in_file,
                       entry.volume.radial_count, *chunks);
}

std::shared_ptr<DecodedVolumes::Held> DecodedVolumes::held(const std::string& key) {
    const MutexLock lock(mutex_);
    if (const auto* known = kept_.find(key)) return *known;
    return kept_.keep(key, std::make_shared<Held>());
}

// Does not keep errors.
Result<DecodedVolumes::Volume> DecodedVolumes::found_or_made(
    const std::string& key, const std::function<Result<Volume>()>& make) {
    const std::shared_ptr<Held> ours = held(key);
    const MutexLock decoding(ours->mutex);
    if (ours->is_decoded) return ours->volume;
    auto made = make();
    if (!made) return made;
    ours->volume = *made;
    ours->is_decoded = true;
    const MutexLock lock(mutex_);
    kept_.keep(key, ours, *made ? bytes_of_volume(**made) : 1);
    return made;
}

DecodedVolumes::Volume DecodedVolumes::find(const VolumeToDecode& wanted) {
    std::shared_ptr<Held> known;
    {
        const MutexLock lock(mutex_);
        if (const auto* found = kept_.find(wanted.key)) known = *found;
    }
    if (!known) return nullptr;
    const MutexLock decoding(known->mutex);
    return known->volume;
}

Result<DecodedVolumes::Volume> DecodedVolumes::find_or_decode(const VolumeToDecode& wanted) {
    return found_or_made(wanted.key, [&] { return decode_whole(wanted); });
}

Result<DecodedVolumes::Volume> DecodedVolumes::find_or_decode_cut(const VolumeToDecode& wanted,
                                                                  int elevation_number) {
    return found_or_made(fmt::format("{}#{}", wanted.key, elevation_number),
                         [&] { return decode_cut(wanted, elevation_number); });
}

}  // namespace stormcellar::web
