// tests/batch/small_archive.h -- an archive of real volumes of KBGM, and recipes for coarse grids.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "batch/frame_task.h"
#include "batch/grid_task.h"
#include "batch/plan.h"
#include "batch/source.h"
#include "batch/statistics_task.h"
#include "stormcellar/base/file_system.h"
#include "tests/pipeline/small_domain.h"
#include "tests/testing/data.h"
#include "tests/testing/file_bytes.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::batch {

inline UtcTime at(const std::string& text) {
    return *parse_utc(text, UtcTime{});
}

// Returns a recipe for mosaics (frames) of the small domain from an archive that no test reads.
inline Recipe recipe_between(const std::string& from, const std::string& to) {
    Recipe recipe;
    recipe.source = "/archive";
    recipe.cache = "/share/cache";
    recipe.from = at(from);
    recipe.to = at(to);
    recipe.domain = pipeline::small_domain();
    return recipe;
}

using testing::tree_of;

class SmallArchive : public ::testing::Test {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        fs::create_directories(raw_ / "day");
        for (const std::string& name : pipeline::sequence) {
            const auto from = testing::real_file("sequence-kbgm") / name;
            const auto to = raw_ / "day" / name;
            fs::copy_file(from, to);
            fs::permissions(to, fs::perms::owner_write, fs::perm_options::add);
            // Tars store times in whole seconds, so round the file's time for comparison.
            fs::last_write_time(
                to, std::chrono::floor<std::chrono::seconds>(fs::last_write_time(from)));
        }
    }

    // Returns a recipe for frames every minute from 02:45 to 03:00, in a cache of this name.
    [[nodiscard]] Recipe recipe(const std::string& cache) const {
        Recipe recipe;
        recipe.source = raw_.native();
        recipe.cache = directory_ / cache;
        recipe.from = at("2005-08-22T02:45Z");
        recipe.to = at("2005-08-22T03:00Z");
        recipe.domain = pipeline::small_domain();
        recipe.domain->stations = {"KBGM"};
        recipe.domain->interval = std::chrono::minutes{1};
        return recipe;
    }
    [[nodiscard]] Plan plan_of(const Recipe& recipe, const std::string& name) const {
        const auto listing =
            list_source(recipe.source, recipe.from - recipe.margin(), recipe.to + recipe.margin());
        EXPECT_TRUE(listing);
        const Status written = write_plan(directory_ / name, recipe, listing->days);
        EXPECT_TRUE(written) << written.error().message;
        return std::move(*Plan::open(directory_ / name));
    }
    [[nodiscard]] Result<TaskOutcome> run(const Plan& plan, std::size_t number) const {
        const Task task = *plan.task(number);
        const testing::TemporaryDirectory scratch;
        const TaskOptions options{1, scratch.path(), stop_};
        if (task.kind() == TaskKind::grids) return run_grid_task(plan, task, options);
        return task.kind() == TaskKind::frames ? run_frame_task(plan, task, options)
                                               : run_statistics_task(plan, task, options);
    }
    void run_all(const Plan& plan) const {
        for (std::size_t number = 0; number < plan.facts().tasks(); ++number) {
            const auto outcome = run(plan, number);
            ASSERT_TRUE(outcome) << outcome.error().message;
        }
    }

    testing::TemporaryDirectory directory_;
    fs::path raw_ = directory_ / "raw";
    std::atomic<bool> stop_{false};
};

}  // namespace stormcellar::batch
