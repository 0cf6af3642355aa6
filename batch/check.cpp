#include "batch/check.h"

#include <algorithm>
#include <span>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "batch/standing.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::batch {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::uint64_t most_summary_bytes = std::uint64_t{64} << 20;
constexpr const char* summary_name = "summary.json";

class Check {
  public:
    Check(const Plan& plan, CheckOptions options) : plan_(plan), options_(std::move(options)) {}

    Result<CheckReport> run() {
        if (options_.deep) {
            auto store = cache::StoreReader::open(plan_.recipe().cache);
            if (store) store_ = std::move(*store);
        }
        const std::size_t all = plan_.facts().tasks();
        for (std::size_t first = 0; first < all; first += records_a_directory) {
            if (options_.progress) options_.progress(first, all);
            const std::size_t end = std::min(first + records_a_directory, all);
            if (Status read = directory(first, end); !read) return pass_on(read);
        }
        report_.cost_left_s = plan_.facts().cost_s - report_.done.cost_s;
        estimate_time_left();
        return std::move(report_);
    }

    // Writes the summary of a directory if all records of the directory exist.
    void sum_up(std::size_t first, std::size_t end) {
        Totals totals;
        for (std::size_t number = first; number < end; ++number) {
            const auto done = look_at(number, totals);
            if (!done || !*done) return;
        }
        write_summary(summary_of(first), totals);
    }

  private:
    [[nodiscard]] fs::path summary_of(std::size_t number) const {
        return record_path(plan_.directory(), number).parent_path() / summary_name;
    }

    Status directory(std::size_t first, std::size_t end) {
        const fs::path path = summary_of(first);
        if (!options_.deep) {
            if (const auto known = read_summary(path, end - first)) {
                add(*known, report_.done);
                return {};
            }
        }
        Totals totals;
        bool is_whole = true;
        for (std::size_t number = first; number < end; ++number) {
            const auto done = look_at(number, totals);
            if (!done) return pass_on(done);
            if (*done) continue;
            report_.missing.push_back(number);
            is_whole = false;
        }
        if (is_whole) write_summary(path, totals);
        add(totals, report_.done);
        return {};
    }

    Result<bool> look_at(std::size_t number, Totals& totals) {
        const auto task = plan_.task(number);
        if (!task) return pass_on(task);
        const auto record = read_record(plan_, *task);
        if (!record) return false;
        if (options_.deep) {
            const auto stand = stands(*task, *record);
            if (!stand) return stand;
            if (!*stand) {
                report_.changed.push_back(number);
                return false;
            }
        }
        add(*record, task->cost_s, totals);
        return true;
    }

    Result<bool> stands(const Task& task, const Record& record) const {
        if (!store_) return false;
        const auto standing = grids_standing(*store_, plan_, task);
        if (!standing) return pass_on(standing);
        if (digest_of(*standing) != record.digest) return false;
        // Frames that lack a damaged grid do not count as done, because the grid may be whole
        // again.
        if (task.kind() == TaskKind::frames && !record.left_out.empty()) return false;
        for (const StandingGrid& grid : *standing) {
            const auto sound = is_sound(grid);
            if (!sound || !*sound) return sound;
        }
        return true;
    }

    std::optional<Totals> read_summary(const fs::path& path, std::size_t tasks) const {
        const auto bytes = read_file(path, most_summary_bytes);
        if (!bytes) return std::nullopt;
        try {
            const Json json =
                Json::parse(reinterpret_cast<const char*>(bytes->data()),
                            reinterpret_cast<const char*>(bytes->data()) + bytes->size());
            Totals totals = totals_of(json);
            const bool is_whole = totals.tasks() == tasks;
            if (is_whole && json.at("plan") == plan_.facts().hash) return totals;
        } catch (const std::exception&) {
            // Treat a damaged summary as missing.
        }
        return std::nullopt;
    }

    // Writes a summary. Ignores a failure, because the next check then reads the records instead.
    void write_summary(const fs::path& path, const Totals& totals) const {
        Json json = json_of(totals);
        json["plan"] = plan_.facts().hash;
        const std::string text = json.dump() + "\n";
        (void)write_file_atomically(real_file_system(), path, std::as_bytes(std::span(text)));
    }

    void estimate_time_left() {
        const Totals& done = report_.done;
        if (!done.started || done.cost_s <= 0) return;
        const double so_far_s = seconds_between(*done.started, *done.ended);
        report_.seconds_left = so_far_s / done.cost_s * report_.cost_left_s;
    }

    const Plan& plan_;
    const CheckOptions options_;
    std::optional<cache::StoreReader> store_;
    CheckReport report_;
};

std::size_t records_in(const fs::path& directory) {
    std::size_t records = 0;
    std::error_code error;
    for (fs::directory_iterator entry(directory, error), end; !error && entry != end;
         entry.increment(error)) {
        const std::string name = entry->path().filename().native();
        if (!name.starts_with('.') && name != summary_name) ++records;
    }
    return records;
}

}  // namespace

Status keep_record(const Plan& plan, const Record& record) {
    if (Status written = write_record(plan.directory(), record); !written) return written;
    const std::size_t first = record.number / records_a_directory * records_a_directory;
    const std::size_t end = std::min(first + records_a_directory, plan.facts().tasks());
    if (records_in(record_path(plan.directory(), first).parent_path()) >= end - first)
        Check(plan, {}).sum_up(first, end);
    return {};
}

Status drop_record(const Plan& plan, const Task& task) {
    const fs::path record = record_path(plan.directory(), task.number);
    for (const fs::path& path : {record.parent_path() / summary_name, record}) {
        std::error_code error;
        fs::remove(path, error);
        if (error) return fail(ErrorCode::io, "{}: {}", path.native(), error.message());
    }
    return {};
}

Result<CheckReport> check(const Plan& plan, const CheckOptions& options) {
    return Check(plan, options).run();
}

std::vector<LeftOutFile> left_out_of(const Plan& plan, const std::vector<std::size_t>& tasks) {
    std::vector<LeftOutFile> files;
    for (const std::size_t number : tasks) {
        const auto task = plan.task(number);
        if (!task) continue;
        const auto record = read_record(plan, *task);
        if (!record) continue;
        for (const NamedReason& file : record->left_out)
            files.push_back({number, file});
    }
    return files;
}

}  // namespace stormcellar::batch
