#include "pipeline/drop/file_facts.h"

#include <algorithm>
#include <chrono>

#include "base/beneath.h"
#include "level2/decode/volume_checks.h"

namespace stormcellar::pipeline {

Result<FileStamp> stamp_of(const std::filesystem::path& path,
                           const std::filesystem::path& beneath) {
    const auto facts = look_beneath(beneath, path);
    if (!facts) return pass_on(facts);
    const auto nanoseconds = [](const timespec& time) {
        return std::int64_t{time.tv_sec} * 1'000'000'000 + std::int64_t{time.tv_nsec};
    };
    return FileStamp{static_cast<std::uint64_t>(facts->st_size), nanoseconds(facts->st_mtim),
                     S_ISREG(facts->st_mode), facts->st_mode & S_IFMT, nanoseconds(facts->st_ctim)};
}

catalog::VolumeFacts facts_of(const level2::Volume& volume, bool damaged) {
    catalog::VolumeFacts facts;
    facts.start_time = volume.start_time();
    if (volume.header) facts.volume_number = volume.header->volume_number();
    facts.vcp = volume.vcp;
    facts.sweep_count = static_cast<int>(volume.sweeps.size());
    facts.radial_count = static_cast<int>(volume.radial_count());
    facts.complete = !damaged && level2::is_complete(volume);
    for (const level2::Sweep& sweep : volume.sweeps) {
        for (const level2::Radial& radial : sweep.radials) {
            if (!level2::is_time_of_volume(radial.time, facts.start_time)) continue;
            facts.end_time = std::max(facts.end_time.value_or(radial.time), radial.time);
        }
    }
    return facts;
}

std::string reason_of(const level2::DecodeReport& report) {
    const auto counts = [](const level2::Problem& problem) {
        return problem.severity != level2::Severity::note;
    };
    const auto number = std::count_if(report.problems.begin(), report.problems.end(), counts);
    if (number == 0) return {};
    const auto gravest =
        std::max_element(report.problems.begin(), report.problems.end(),
                         [](const auto& a, const auto& b) { return a.severity < b.severity; });
    if (number == 1) return gravest->text();
    return fmt::format("{} (and {} more)", gravest->text(), number - 1);
}

}  // namespace stormcellar::pipeline
