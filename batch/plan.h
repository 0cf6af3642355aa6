// batch/plan.h -- the file of a plan: a line for each task that helps to make an archive of grids.
//
// PLAN/plan.jsonl has one JSON document on each line. The first line holds the recipe. Each further
// line is a task. Blanks make all lines equally long, so that a program finds task N without
// reading other lines. docs/guides/batch.md lists the fields. Grid tasks come first, by day and
// then station; then frame tasks, by hour; then statistics tasks, by month and hour of the day. The
// same source, range and recipe give the same bytes.
//
// Threads   Many threads may read a plan.
// Errors    not_found, corrupt, io; bad_argument for a number without a task.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "batch/recipe.h"
#include "batch/source.h"
#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/result.h"

namespace stormcellar::batch {

// The frames of an hour. They need the grids that the tasks [first_need, end_need) make.
struct FrameHour {
    UtcTime from, to;  // inclusive
    std::size_t first_need = 0, end_need = 0;
};

// The statistics of a month's frames in one hour of the day (batch/statistics_task.h).
struct MonthHour {
    int year = 0;
    unsigned month = 0;
    int hour = 0;
    std::size_t first_need = 0, end_need = 0;
};

enum class TaskKind { grids, frames, statistics };

struct Task {
    std::size_t number = 0;
    double cost_s = 0;                                    // estimated processor time
    std::variant<StationDay, FrameHour, MonthHour> work;  // in the order of TaskKind

    [[nodiscard]] TaskKind kind() const { return static_cast<TaskKind>(work.index()); }
};

struct PlanFacts {
    std::string hash;  // of the recipe
    std::size_t grid_tasks = 0, frame_tasks = 0, statistics_tasks = 0;
    std::size_t volumes = 0;    // 0: not known before the tasks run
    std::uint64_t bytes = 0;    // of the raw files
    std::uint64_t largest = 0;  // of the largest station-day
    double cost_s = 0;          // sum over all tasks
    double largest_cost_s = 0;  // estimate of the most expensive task

    [[nodiscard]] std::size_t tasks() const { return grid_tasks + frame_tasks + statistics_tasks; }
};

class Plan {
  public:
    static constexpr const char* file_name = "plan.jsonl";

    [[nodiscard]] static Result<Plan> open(const std::filesystem::path& directory);

    [[nodiscard]] const std::filesystem::path& directory() const { return directory_; }
    [[nodiscard]] const Recipe& recipe() const { return recipe_; }
    [[nodiscard]] const PlanFacts& facts() const { return facts_; }
    [[nodiscard]] Result<Task> task(std::size_t number) const;

  private:
    Plan(std::filesystem::path directory, Descriptor file)
        : directory_(std::move(directory)), file_(std::move(file)) {}
    Status read_header();

    std::filesystem::path directory_;
    Descriptor file_;
    Recipe recipe_;
    PlanFacts facts_;
    std::uint64_t first_task_at_ = 0, task_bytes_ = 0;
};

// Returns true if a plan can hold the text unchanged: UTF-8 without control characters.
[[nodiscard]] bool is_plan_text(const std::string& text);

// Writes a plan for these station-days. Errors: also bad_argument if the directory has another
// plan, or if there is nothing to do.
[[nodiscard]] Status write_plan(const std::filesystem::path& directory, const Recipe& recipe,
                                const std::vector<StationDay>& days);

}  // namespace stormcellar::batch
