// tests/daemon/hostile_drop.h -- runs the real program on a hostile drop directory.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "stormcellar/catalog/catalog.h"
#include "tests/daemon/running_daemon.h"
#include "tests/daemon/write_file.h"
#include "tests/level2/wire.h"
#include "tests/testing/slow_down.h"

namespace stormcellar::daemon {

// The memory that the program may take with two workers. A volume of a real radar takes a fifth of
// it.
inline constexpr long most_mib = 1024;
// Limit of waits that take some seconds on an idle machine.
inline constexpr double most_seconds = 60.0 * testing::slow_down;

#if defined(STORMCELLAR_SANITIZED)
inline constexpr bool memory_is_ours = false;
#else
inline constexpr bool memory_is_ours = true;
#endif

inline constexpr const char* hasty =
    "[ingest]\nworkers = 2\nthreads = 2\nquiet_seconds = 1\nspacing_km = 4\n"
    "[watch]\nrescan_seconds = 1\n[log]\nlevel = \"debug\"\n";

class HostileDrop : public ::testing::Test {
  protected:
    HostileDrop() { std::filesystem::create_directory(outside()); }

    [[nodiscard]] std::filesystem::path drop() const { return daemon_.drop(); }
    [[nodiscard]] std::filesystem::path outside() const { return daemon_.root() / "outside"; }
    static void put(const std::filesystem::path& path, const level2::wire::Bytes& bytes) {
        std::filesystem::create_directories(path.parent_path());
        write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    }
    // Returns a volume of the tests' site. The number of sweeps tells volumes apart.
    static level2::wire::Bytes volume(unsigned sweeps = 2) {
        return level2::wire::ldm_volume(sweeps, 360);
    }
    void start() {
        daemon_.start(hasty);
        ASSERT_TRUE(daemon_.wait_for([](const nlohmann::json& s) {
            return s["state"] == "running";
        })) << daemon_.log();
    }
    bool wait_until_gridded(const std::string& name) {
        return daemon_.wait_for([&](const nlohmann::json& status) {
            return std::any_of(status["volumes"].begin(), status["volumes"].end(),
                               [&](const nlohmann::json& file) {
                                   return std::string{file["file"]}.ends_with(name);
                               });
        });
    }
    bool wait_until_rejected(std::size_t files) {
        return daemon_.wait_for(
            [&](const nlohmann::json& status) { return status["rejected"] >= files; });
    }
    // Returns the reason why the file was rejected; empty if the file was not rejected.
    std::string reason_of(const std::string& name) {
        const nlohmann::json status = daemon_.status();
        for (const nlohmann::json& file : status["rejected_files"]) {
            if (std::string{file["file"]}.ends_with(name)) return file["reason"];
        }
        return {};
    }
    bool was_said(const std::string& text) {
        if (daemon_.wait_for_log(text)) return true;
        std::printf("%s is not in\n%s", text.c_str(), daemon_.log().c_str());
        return false;
    }
    void expect_bounded(const char* what) {
        const long peak = daemon_.peak_mib();
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin_;
        std::printf("%s: peak %ld MiB, %.2f s\n", what, peak, took.count());
        EXPECT_GT(peak, 0);
        if (memory_is_ours) {
            EXPECT_LT(peak, most_mib);
        }
        EXPECT_LT(took.count(), most_seconds);
    }
    // Returns the number of sweeps of each volume in the catalog, whatever its state.
    std::multiset<int> sweeps_known() {
        std::multiset<int> sweeps;
        auto catalog = catalog::CatalogReader::open(daemon_.catalog());
        if (!catalog) return sweeps;
        const auto entries = catalog->list("KTLX", {std::nullopt, std::nullopt, true});
        if (!entries) return sweeps;
        for (const catalog::CatalogEntry& entry : *entries)
            sweeps.insert(entry.volume.sweep_count);
        return sweeps;
    }

    RunningDaemon daemon_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace stormcellar::daemon
