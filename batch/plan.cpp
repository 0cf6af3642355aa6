#include "batch/plan.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <map>
#include <span>
#include <system_error>
#include <tuple>
#include <utility>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "base/printable.h"
#include "base/system_error.h"
#include "pipeline/mosaic/domain_frames.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/version.h"

namespace stormcellar::batch {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using std::chrono::days;
using std::chrono::hours;

constexpr int version = 1;
constexpr std::size_t most_header_bytes = std::size_t{1} << 20;
constexpr std::size_t most_task_bytes = std::size_t{1} << 20;

// Estimates for gridding: bytes of raw files per second and processor, and the cost of each further
// moment as a share of the first moment's cost. docs/scaling.md has measured rates.
constexpr double grid_bytes_a_second = 35e6;
constexpr double share_of_more_moments = 0.6;
// Estimated seconds for a million cells of a frame: with motion, without motion, and for counting.
constexpr double advected_s = 0.2, plain_s = 0.005, statistics_s = 0.01;

double cost_of(const Recipe& recipe, const StationDay& day) {
    const auto bytes = static_cast<double>(day.files == 0 ? bytes_of_unlisted_day : day.bytes);
    const auto more = static_cast<double>(recipe.moments.size() - 1);
    return std::ceil(bytes / grid_bytes_a_second * (1 + share_of_more_moments * more));
}

double cost_of(const Recipe& recipe, const FrameHour& hour) {
    const pipeline::Domain& domain = *recipe.domain;
    const auto frames = pipeline::instants_between(hour.from, hour.to, domain.interval).size();
    const double million_cells = static_cast<double>(domain.spec.cell_count()) / 1e6;
    const double a_frame =
        million_cells * (domain.time == grid::TimeMethod::advected ? advected_s : plain_s);
    return std::ceil(a_frame * static_cast<double>(frames * recipe.moments.size()));
}

double cost_of(const Recipe& recipe, const MonthHour&) {
    constexpr double days_a_month = 31;
    const double frames =
        days_a_month * 3600 / static_cast<double>(recipe.domain->interval.count());
    return std::ceil(frames * statistics_s * static_cast<double>(recipe.domain->spec.cell_count()) /
                     1e6);
}

// Returns the task of an hour's frames. The volumes that the frames need begin on the hour's day or
// on a day beside it.
FrameHour hour_of(const Recipe& recipe, UtcTime begin, const std::vector<StationDay>& all) {
    const UtcTime from = std::max(begin, recipe.from);
    const UtcTime to = std::min(begin + hours{1} - std::chrono::milliseconds{1}, recipe.to);
    const auto first_day = std::chrono::floor<days>(from - recipe.margin());
    const auto last_day = std::chrono::floor<days>(to + recipe.margin());
    const auto first = std::ranges::lower_bound(all, first_day, {}, &StationDay::day);
    const auto end = std::ranges::upper_bound(all, last_day, {}, &StationDay::day);
    return {from, to, static_cast<std::size_t>(first - all.begin()),
            static_cast<std::size_t>(end - all.begin())};
}

std::vector<FrameHour> hours_of(const Recipe& recipe, const std::vector<StationDay>& all) {
    std::vector<FrameHour> found;
    if (!recipe.domain) return found;
    for (auto begin = std::chrono::floor<hours>(recipe.from); begin <= recipe.to;
         begin += hours{1}) {
        const FrameHour hour = hour_of(recipe, begin, all);
        const bool has_frames =
            !pipeline::instants_between(hour.from, hour.to, recipe.domain->interval).empty();
        if (has_frames && hour.first_need < hour.end_need) found.push_back(hour);
    }
    return found;
}

// Returns the tasks of statistics. A task needs all frames of its month, whose tasks are
// consecutive.
std::vector<MonthHour> months_of(const Recipe& recipe, const std::vector<FrameHour>& frames,
                                 std::size_t first_frame_task) {
    std::map<std::tuple<int, unsigned, int>, MonthHour> found;
    std::map<std::pair<int, unsigned>, std::pair<std::size_t, std::size_t>> needs;
    if (!recipe.statistics) return {};
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const auto day = std::chrono::floor<days>(frames[i].from);
        const std::chrono::year_month_day date{day};
        const int year = static_cast<int>(date.year());
        const auto month = static_cast<unsigned>(date.month());
        const auto hour = static_cast<int>((frames[i].from - UtcTime{day}) / hours{1});
        found[{year, month, hour}] = {year, month, hour, 0, 0};
        needs.try_emplace({year, month}, first_frame_task + i, 0);
        needs[{year, month}].second = first_frame_task + i + 1;
    }
    std::vector<MonthHour> parts;
    for (auto& [key, part] : found) {
        std::tie(part.first_need, part.end_need) = needs.at({part.year, part.month});
        parts.push_back(part);
    }
    return parts;
}

std::string day_text(std::chrono::sys_days day) {
    return format_compact(UtcTime{day}).substr(0, 8);
}

std::string line_of(std::size_t number, const StationDay& day, double cost_s) {
    Json json{
        {"n", number},  {"kind", "grid"},     {"station", day.station}, {"day", day_text(day.day)},
        {"in", day.in}, {"files", day.files}, {"bytes", day.bytes},     {"cost_s", cost_s}};
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string line_of(std::size_t number, const FrameHour& hour, double cost_s) {
    return Json{{"n", number},
                {"kind", "frames"},
                {"from", format_utc(hour.from)},
                {"to", format_utc(hour.to)},
                {"needs", {hour.first_need, hour.end_need}},
                {"cost_s", cost_s}}
        .dump();
}

std::string line_of(std::size_t number, const MonthHour& part, double cost_s) {
    return Json{{"n", number},       {"kind", "statistics"},
                {"year", part.year}, {"month", part.month},
                {"hour", part.hour}, {"needs", {part.first_need, part.end_need}},
                {"cost_s", cost_s}}
        .dump();
}

// Collects the lines of a plan, and the sums for its first line.
class PlanText {
  public:
    explicit PlanText(const Recipe& recipe) : recipe_(recipe) { facts_.hash = hash_of(recipe); }

    void add(const StationDay& day) {
        add_line(day, cost_of(recipe_, day));
        ++facts_.grid_tasks;
        facts_.volumes += day.files;
        facts_.bytes += day.bytes;
        facts_.largest = std::max(facts_.largest, day.bytes);
    }
    void add(const FrameHour& hour) {
        add_line(hour, cost_of(recipe_, hour));
        ++facts_.frame_tasks;
    }

    void add(const MonthHour& part) {
        add_line(part, cost_of(recipe_, part));
        ++facts_.statistics_tasks;
    }

    [[nodiscard]] std::string text() {
        std::size_t longest = 0;
        for (const std::string& line : lines_)
            longest = std::max(longest, line.size());
        std::string text = header(longest + 1) + "\n";
        text.reserve(text.size() + lines_.size() * (longest + 1));
        for (std::string& line : lines_) {
            line.resize(longest, ' ');
            text += line;
            text += '\n';
        }
        return text;
    }

  private:
    template <class Work>
    void add_line(const Work& work, double cost_s) {
        lines_.push_back(line_of(lines_.size(), work, cost_s));
        facts_.cost_s += cost_s;
        facts_.largest_cost_s = std::max(facts_.largest_cost_s, cost_s);
    }
    [[nodiscard]] std::string header(std::size_t task_bytes) const {
        return Json{{"version", version},
                    {"software", software_version},
                    {"hash", facts_.hash},
                    {"task_bytes", task_bytes},
                    {"grid_tasks", facts_.grid_tasks},
                    {"frame_tasks", facts_.frame_tasks},
                    {"statistics_tasks", facts_.statistics_tasks},
                    {"volumes", facts_.volumes},
                    {"bytes", facts_.bytes},
                    {"largest_bytes", facts_.largest},
                    {"cost_s", facts_.cost_s},
                    {"largest_cost_s", facts_.largest_cost_s},
                    {"recipe", json_of(recipe_)}}
            .dump(-1, ' ', false, Json::error_handler_t::replace);
    }

    const Recipe& recipe_;
    PlanFacts facts_;
    std::vector<std::string> lines_;
};

Result<std::string> read_at(const Descriptor& file, const fs::path& path, std::uint64_t at,
                            std::size_t most) {
    std::string text(most, '\0');
    std::size_t have = 0;
    while (have < most) {
        const ssize_t got =
            ::pread(file.number(), text.data() + have, most - have, static_cast<off_t>(at + have));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return system_failure(path.native(), errno);
        if (got == 0) break;
        have += static_cast<std::size_t>(got);
    }
    text.resize(have);
    return text;
}

// Reads a task. Throws the exceptions of nlohmann::json.
Task task_of(const Json& json) {
    Task task;
    task.number = json.at("n");
    task.cost_s = json.at("cost_s");
    if (json.at("kind") == "frames") {
        FrameHour hour;
        hour.from = parse_utc(json.at("from").get<std::string>(), {}).value();
        hour.to = parse_utc(json.at("to").get<std::string>(), {}).value();
        hour.first_need = json.at("needs").at(0);
        hour.end_need = json.at("needs").at(1);
        task.work = hour;
        return task;
    }
    if (json.at("kind") == "statistics") {
        MonthHour part;
        part.year = json.at("year");
        part.month = json.at("month");
        part.hour = json.at("hour");
        part.first_need = json.at("needs").at(0);
        part.end_need = json.at("needs").at(1);
        task.work = part;
        return task;
    }
    StationDay day;
    day.station = json.at("station");
    day.day = std::chrono::floor<days>(
        parse_compact(json.at("day").get<std::string>() + "_000000").value());
    json.at("in").get_to(day.in);
    day.files = json.at("files");
    day.bytes = json.at("bytes");
    task.work = std::move(day);
    return task;
}

}  // namespace

Result<Plan> Plan::open(const fs::path& directory) {
    std::error_code error;
    const fs::path absolute = fs::absolute(directory, error).lexically_normal();
    const fs::path path = absolute / file_name;
    Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
    if (!file.is_open()) return system_failure(path.native(), errno);
    Plan plan(absolute, std::move(file));
    if (Status read = plan.read_header(); !read) return pass_on(read);
    return plan;
}

Status Plan::read_header() {
    const fs::path path = directory_ / file_name;
    const auto text = read_at(file_, path, 0, most_header_bytes);
    if (!text) return pass_on(text);
    const std::size_t end = text->find('\n');
    const Json json = Json::parse(text->substr(0, end), nullptr, false);
    if (end == std::string::npos || json.is_discarded()) {
        return fail(ErrorCode::corrupt, "{}: is not a plan", path.native());
    }
    first_task_at_ = end + 1;
    try {
        if (json.at("version") != version || json.at("software") != software_version) {
            return fail(ErrorCode::unsupported,
                        "{}: is a plan of another version of stormcellar; make it again",
                        path.native());
        }
        task_bytes_ = json.at("task_bytes");
        facts_ = {json.at("hash"),          json.at("grid_tasks"),
                  json.at("frame_tasks"),   json.at("statistics_tasks"),
                  json.at("volumes"),       json.at("bytes"),
                  json.at("largest_bytes"), json.at("cost_s"),
                  json.at("largest_cost_s")};
        auto recipe = recipe_of(json.at("recipe"));
        if (!recipe) return pass_on(recipe);
        recipe_ = std::move(*recipe);
    } catch (const nlohmann::json::exception& error) {
        return fail(ErrorCode::corrupt, "{}: is damaged: {}", path.native(), error.what());
    }
    if (task_bytes_ < 2 || task_bytes_ > most_task_bytes || facts_.hash != hash_of(recipe_)) {
        return fail(ErrorCode::corrupt, "{}: is damaged", path.native());
    }
    return {};
}

Result<Task> Plan::task(std::size_t number) const {
    const fs::path path = directory_ / file_name;
    if (number >= facts_.tasks()) {
        return fail(ErrorCode::bad_argument, "{}: has no task {}; its tasks are 0 to {}",
                    path.native(), number, facts_.tasks() - 1);
    }
    const auto line = read_at(file_, path, first_task_at_ + number * task_bytes_, task_bytes_);
    if (!line) return pass_on(line);
    try {
        Task task = task_of(Json::parse(*line));
        if (task.number == number) return task;
    } catch (const std::exception&) {
        // The error below reports the damaged line.
    }
    return fail(ErrorCode::corrupt, "{}: the line of task {} is damaged", path.native(), number);
}

bool is_plan_text(const std::string& text) {
    const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7F; };
    if (std::ranges::any_of(text, is_control)) return false;
    try {
        (void)Json(text).dump();
    } catch (const Json::type_error&) {
        return false;
    }
    return true;
}

Status write_plan(const fs::path& directory, const Recipe& recipe,
                  const std::vector<StationDay>& all) {
    if (all.empty()) {
        return fail(ErrorCode::not_found, "{}: has no volume of these stations and times",
                    recipe.source);
    }
    for (const std::string& name :
         {directory.native(), fs::path(recipe.source).native(), fs::path(recipe.cache).native()}) {
        if (!is_plan_text(name)) {
            return fail(
                ErrorCode::bad_argument,
                "{}: a plan cannot hold this path: it has control characters or is no UTF-8",
                printable(name));
        }
    }
    PlanText plan(recipe);
    for (const StationDay& day : all)
        plan.add(day);
    const std::vector<FrameHour> frames = hours_of(recipe, all);
    for (const FrameHour& hour : frames)
        plan.add(hour);
    for (const MonthHour& part : months_of(recipe, frames, all.size()))
        plan.add(part);
    const std::string text = plan.text();
    const auto bytes = std::as_bytes(std::span(text));
    std::error_code error;
    fs::create_directories(directory, error);
    if (error) return fail(ErrorCode::io, "{}: {}", directory.native(), error.message());
    const fs::path path = directory / Plan::file_name;
    constexpr std::uint64_t no_limit = ~std::uint64_t{0} - 1;
    if (fs::exists(path, error)) {
        const auto old = read_file(path, no_limit);
        if (old && std::ranges::equal(*old, bytes)) return {};
        return fail(ErrorCode::bad_argument,
                    "{}: is another plan, or its source has changed; choose another directory",
                    path.native());
    }
    return write_file_atomically(real_file_system(), path, bytes);
}

}  // namespace stormcellar::batch
