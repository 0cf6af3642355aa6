#include "batch/statistics_task.h"

#include <algorithm>
#include <span>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>
#include <zlib.h>

#include "base/checksum.h"
#include "batch/check.h"
#include "batch/frame_task.h"
#include "batch/held_cache.h"
#include "batch/standing.h"
#include "batch/usage.h"
#include "pipeline/mosaic/domain_frames.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::batch {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::uint64_t most_tally_bytes = std::uint64_t{8} << 30;
// zlib level; most counts are small numbers, so more effort saves little
constexpr int fastest = 1;

std::string name_of(const MonthHour& part) {
    return fmt::format("{:04}{:02}-{:02}", part.year, part.month, part.hour);
}

// Returns the instants at which the hour can have frames, on all days of the month.
std::vector<UtcTime> instants_of(const Recipe& recipe, const MonthHour& part) {
    using namespace std::chrono;
    const auto first = year{part.year} / month{part.month} / day{1};
    const sys_days begin{first}, end{first + months{1}};
    std::vector<UtcTime> all;
    for (sys_days at = begin; at < end; at += days{1}) {
        const UtcTime from = std::max<UtcTime>(UtcTime{at} + hours{part.hour}, recipe.from);
        const UtcTime to =
            std::min(UtcTime{at} + hours{part.hour + 1} - milliseconds{1}, recipe.to);
        if (from > to) continue;
        const auto instants = pipeline::instants_between(from, to, recipe.domain->interval);
        all.insert(all.end(), instants.begin(), instants.end());
    }
    return all;
}

// Adds the existing frames to `tally` and returns their size on disk. An instant has no frame if no
// volumes were made around it.
Result<std::uint64_t> count_frames(const cache::StoreReader& store, const Recipe& recipe,
                                   const std::vector<UtcTime>& instants, const TaskOptions& options,
                                   grid::GridTally& tally) {
    std::uint64_t bytes = 0;
    for (const UtcTime instant : instants) {
        if (options.stop) return fail(ErrorCode::busy, "stopped; the next run begins again");
        const auto path = store.path_of(recipe.domain->name, recipe.moments.front(), instant);
        if (!path) return pass_on(path);
        const auto frame = cache::GridFile::open(*path);
        if (!frame && frame.error().code == ErrorCode::not_found) continue;
        if (!frame) return pass_on(frame);
        if (Status sound = frame->verify(); !sound) return pass_on(sound);
        if (Status added = tally.add(frame->view()); !added) return pass_on(added);
        if (Status whole = frame->check_whole(); !whole) return pass_on(whole);
        bytes += frame->bytes_on_disk();
    }
    return bytes;
}

std::vector<std::byte> packed(const std::vector<std::byte>& bytes) {
    uLongf size = ::compressBound(bytes.size());
    std::vector<std::byte> packed(size);
    ::compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), fastest);
    packed.resize(size);
    return packed;
}

std::string hash_text(std::span<const std::byte> bytes) {
    return fmt::format("{:016x}", xxh3_64(bytes));
}

Status write_tally(const Plan& plan, const MonthHour& part, const MonthTally& counted) {
    const fs::path path = tally_path(plan, part);
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error) {
        return fail(ErrorCode::io, "{}: {}", path.parent_path().native(), error.message());
    }
    const std::vector<std::byte> counts = packed(counted.tally.to_bytes());
    const std::string header = Json{{"plan", plan.facts().hash},
                                    {"month", name_of(part).substr(0, 6)},
                                    {"hour", part.hour},
                                    {"frames", counted.tally.grids()},
                                    {"instants", counted.instants},
                                    {"bytes", counts.size()},
                                    {"checksum", hash_text(counts)}}
                                   .dump() +
                               "\n";
    auto file = AtomicFile::create(real_file_system(), path);
    if (!file) return pass_on(file);
    if (Status done = file->append(std::as_bytes(std::span(header))); !done) return done;
    if (Status done = file->append(counts); !done) return done;
    return file->commit();
}

Status unpack(std::span<const std::byte> packed, grid::GridTally& tally) {
    std::vector<std::byte> bytes(tally.bytes());
    uLongf size = bytes.size();
    const int done = ::uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size,
                                  reinterpret_cast<const Bytef*>(packed.data()), packed.size());
    if (done != Z_OK || size != bytes.size()) {
        return fail(ErrorCode::corrupt, "its counts cannot be unpacked");
    }
    return tally.from_bytes(bytes);
}

grid::GridTally empty_tally(const Recipe& recipe) {
    return {recipe.domain->spec, grid::default_quantization(recipe.moments.front()),
            recipe.statistics.value_or(grid::Tallied::columns)};
}

}  // namespace

fs::path tally_path(const Plan& plan, const MonthHour& part) {
    return plan.directory() / "statistics" / (name_of(part) + ".tally");
}

Result<MonthTally> read_tally(const Plan& plan, const MonthHour& part) {
    const fs::path path = tally_path(plan, part);
    const auto bytes = read_file(path, most_tally_bytes);
    if (!bytes) return pass_on(bytes);
    const auto newline = std::ranges::find(*bytes, std::byte{'\n'});
    const auto* const text = reinterpret_cast<const char*>(bytes->data());
    const Json header = Json::parse(text, text + (newline - bytes->begin()), nullptr, false);
    if (newline == bytes->end() || !header.is_object()) {
        return fail(ErrorCode::corrupt, "{}: is no file of counts", path.native());
    }
    const auto counts =
        std::span(*bytes).subspan(static_cast<std::size_t>(newline - bytes->begin()) + 1);
    MonthTally read{empty_tally(plan.recipe()), 0};
    const auto frames = header.value("frames", std::uint64_t{0});
    read.instants = header.value("instants", std::uint64_t{0});
    const bool is_sound = header.value("plan", "") == plan.facts().hash &&
                          header.value("checksum", "") == hash_text(counts);
    if (!is_sound) return fail(ErrorCode::corrupt, "{}: is damaged", path.native());
    if (Status unpacked = unpack(counts, read.tally); !unpacked) {
        return fail(ErrorCode::corrupt, "{}: {}", path.native(), unpacked.error().message);
    }
    if (read.tally.grids() != frames || frames > read.instants) {
        return fail(ErrorCode::corrupt, "{}: contradicts itself", path.native());
    }
    return read;
}

Result<TaskOutcome> run_statistics_task(const Plan& plan, const Task& task,
                                        const TaskOptions& options) {
    const auto& part = std::get<MonthHour>(task.work);
    const Recipe& recipe = plan.recipe();
    const HeldCache held(recipe.cache);
    if (Status met = check_needs(plan, part.first_need, part.end_need); !met) return pass_on(met);
    const auto store = cache::StoreReader::open(recipe.cache);
    if (!store) return pass_on(store);
    if (auto record = read_record(plan, task)) {
        const auto standing = grids_standing(*store, plan, task);
        if (!standing) return pass_on(standing);
        if (digest_of(*standing) == record->digest) return TaskOutcome{true, std::move(*record)};
    }
    const Usage usage;
    Record record;
    record.number = task.number;
    record.kind = task.kind();
    record.plan = plan.facts().hash;
    const auto instants = instants_of(recipe, part);
    MonthTally counted{empty_tally(recipe), instants.size()};
    const auto read = count_frames(*store, recipe, instants, options, counted.tally);
    if (!read) return pass_on(read);
    if (Status same = held.check(); !same) return pass_on(same);
    if (Status written = write_tally(plan, part, counted); !written) return pass_on(written);
    const auto standing = grids_standing(*store, plan, task);
    if (!standing) return pass_on(standing);
    record.bytes_read = *read;
    record.grids = counted.tally.grids();
    record.digest = digest_of(*standing);
    for (const StandingGrid& one : *standing)
        record.bytes_written += one.bytes;
    usage.end(record);
    if (Status written = keep_record(plan, record); !written) return pass_on(written);
    return TaskOutcome{false, std::move(record)};
}

}  // namespace stormcellar::batch
