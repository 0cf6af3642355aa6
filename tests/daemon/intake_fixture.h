// tests/daemon/intake_fixture.h -- an Intake on a directory, with a clock that only the test
// advances.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "daemon/queue/intake.h"
#include "tests/daemon/fake_sink.h"
#include "tests/daemon/write_file.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {

inline constexpr std::int64_t second_ns = 1'000'000'000;

class IntakeTest : public ::testing::Test {
  protected:
    static Config config() {
        Config made;
        made.reloadable.workers = 100;  // many, because the tests do not end most jobs
        made.reloadable.quiet = std::chrono::seconds{30};
        made.reloadable.reread = std::chrono::milliseconds{500};
        made.fixed.queue_limit = 4;
        return made;
    }
    [[nodiscard]] std::filesystem::path at(const char* name) const { return directory_ / name; }
    // Writes a file, so that the intake can read a stamp, and sets its time to long ago.
    FileStamp make(const char* name, std::string_view text = "1") {
        write_file(at(name), text);
        FileStamp stamp = look_at(at(name)).stamp;
        stamp.modified_ns -= 100 * second_ns;
        return stamp;
    }
    std::string next() {
        const auto job = intake_.next_job();
        if (!job) return "";
        return job->path.filename().native() + (job->finish_as_is ? "!" : "");
    }
    void end(const char* name, Result<pipeline::IngestOutcome> outcome) {
        Finished finished{.job = {}, .taken = Taken{}, .started = now_, .ended = now_};
        finished.job.path = at(name);
        if (outcome) {
            finished.taken = Taken{look_at(at(name)).stamp, *outcome};
        } else {
            finished.taken = tl::unexpected<Error>(outcome.error());
        }
        intake_.job_ended(finished);
    }
    // Begins the jobs of the files "a" and "b".
    void begin_two() {
        for (const char* name : {"a", "b"}) {
            intake_.file_closed(at(name), make(name));
            EXPECT_EQ(next(), name);
        }
    }
    // Returns the outcome of a chunk that represents its volume in place of the chunk `former`.
    [[nodiscard]] pipeline::IngestOutcome incomplete_after(const char* former) const {
        pipeline::IngestOutcome outcome = outcome_of(pipeline::IngestResult::incomplete);
        outcome.former_representative = at(former);
        return outcome;
    }
    void end(const char* name, pipeline::IngestResult result) { end(name, outcome_of(result)); }

    testing::TemporaryDirectory directory_;
    SteadyTime now_ = SteadyTime{} + std::chrono::hours{1};
    std::int64_t wall_ns_ = 1'900'000'000 * second_ns;
    Intake intake_{config(), {[this] { return now_; }, [this] { return wall_ns_; }}};
};

}  // namespace stormcellar::daemon
