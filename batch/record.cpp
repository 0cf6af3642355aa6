#include "batch/record.h"

#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>
#include <system_error>

#include <nlohmann/json.hpp>

#include "stormcellar/base/file_system.h"

namespace stormcellar::batch {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// The names of the kinds, in the order of TaskKind.
constexpr std::array<const char*, 3> kinds{"grid", "frames", "statistics"};
constexpr std::uint64_t most_record_bytes = std::uint64_t{64} << 20;

Json json_of(const std::vector<NamedReason>& reasons) {
    Json list = Json::array();
    for (const NamedReason& one : reasons)
        list.push_back({{"name", one.name}, {"reason", one.reason}});
    return list;
}

// Reads reasons. Throws the exceptions of nlohmann::json.
std::vector<NamedReason> reasons_of(const Json& json) {
    std::vector<NamedReason> reasons;
    for (const Json& one : json)
        reasons.push_back({one.at("name"), one.at("reason")});
    return reasons;
}

Json json_of(const Record& record) {
    Json json{{"n", record.number},
              {"kind", kinds.at(static_cast<std::size_t>(record.kind))},
              {"plan", record.plan}};
    if (record.kind == TaskKind::grids) {
        json["station"] = record.station;
        json["day"] = record.day;
        json["files"] = record.files;
        json["taken_by_hour"] = record.taken_by_hour;
        json["left_out_by_hour"] = record.left_out_by_hour;
    }
    json["grids"] = record.grids;
    json["digest"] = record.digest;
    json["left_out"] = json_of(record.left_out);
    json["notes"] = json_of(record.notes);
    json["started"] = format_utc(record.started);
    json["ended"] = format_utc(record.ended);
    json["cpu_s"] = record.cpu_s;
    json["bytes_read"] = record.bytes_read;
    json["bytes_written"] = record.bytes_written;
    json["memory_bytes"] = record.memory_bytes;
    json["host"] = record.host;
    return json;
}

Record read_fields(const Json& json) {
    Record record;
    record.number = json.at("n");
    const auto kind = std::ranges::find(kinds, json.at("kind").get<std::string>());
    if (kind == kinds.end()) throw std::domain_error("its kind is not known");
    record.kind = static_cast<TaskKind>(kind - kinds.begin());
    record.plan = json.at("plan");
    if (record.kind == TaskKind::grids) {
        record.station = json.at("station");
        record.day = json.at("day");
        record.files = json.at("files");
        json.at("taken_by_hour").get_to(record.taken_by_hour);
        json.at("left_out_by_hour").get_to(record.left_out_by_hour);
    }
    record.grids = json.at("grids");
    record.digest = json.at("digest");
    record.notes = reasons_of(json.at("notes"));
    // A record of frames lacks this list if the record was written before 2026-11-29.
    if (json.contains("left_out")) record.left_out = reasons_of(json.at("left_out"));
    record.started = parse_utc(json.at("started").get<std::string>(), {}).value();
    record.ended = parse_utc(json.at("ended").get<std::string>(), {}).value();
    record.cpu_s = json.at("cpu_s");
    record.bytes_read = json.at("bytes_read");
    record.bytes_written = json.at("bytes_written");
    record.memory_bytes = json.at("memory_bytes");
    record.host = json.at("host");
    return record;
}

bool is_of(const Record& record, const Plan& plan, const Task& task) {
    if (record.number != task.number || record.plan != plan.facts().hash) return false;
    if (record.kind != task.kind()) return false;
    const auto* const day = std::get_if<StationDay>(&task.work);
    return day == nullptr || (record.station == day->station &&
                              record.day == format_compact(UtcTime{day->day}).substr(0, 8));
}

}  // namespace

fs::path record_path(const fs::path& plan, std::size_t number) {
    return plan / "tasks" / fmt::format("{:05}", number / records_a_directory) /
           fmt::format("{}.json", number);
}

std::string text_of(const Record& record) {
    return json_of(record).dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Status write_record(const fs::path& plan, const Record& record) {
    const fs::path path = record_path(plan, record.number);
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error) {
        return fail(ErrorCode::io, "{}: {}", path.parent_path().native(), error.message());
    }
    const std::string text = text_of(record);
    return write_file_atomically(real_file_system(), path, std::as_bytes(std::span(text)));
}

Result<Record> parse_record(std::string_view text) {
    try {
        return read_fields(Json::parse(text));
    } catch (const std::exception& error) {
        return fail(ErrorCode::corrupt, "is not the record of a task: {}", error.what());
    }
}

std::optional<Record> read_record(const Plan& plan, const Task& task) {
    const auto bytes = read_file(record_path(plan.directory(), task.number), most_record_bytes);
    if (!bytes) return std::nullopt;
    const auto record = parse_record({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
    if (!record || !is_of(*record, plan, task)) return std::nullopt;
    return *record;
}

}  // namespace stormcellar::batch
