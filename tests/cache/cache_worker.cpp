// This program works on a cache, as a separate process of processes_test.cpp.
//   cache_worker write CACHE BYTES SEED BEGUN
//       commits, replaces and evicts until it is killed; creates BEGUN after the first commit
//   cache_worker read CACHE STOP
//       reads all grids again and again until STOP exists; ends with status 1 if a grid is not
//       whole
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <string>

#include "stormcellar/cache/store.h"
#include "tests/cache/made_grids.h"

namespace {

namespace fs = std::filesystem;
using namespace stormcellar;

int write(const fs::path& cache, std::uint64_t bytes, unsigned seed, const fs::path& begun) {
    cache::Budgets budgets;
    budgets.total.bytes = bytes;
    budgets.low_watermark = 0.8;
    auto store = cache::RollingStore::open(real_file_system(), cache, budgets);
    if (!store) {
        std::fprintf(stderr, "%s\n", store.error().message.c_str());
        return 1;
    }
    std::mt19937 random(seed);
    const UtcTime start = *parse_utc("2024-11-22T12:00", UtcTime{}) + std::chrono::hours{seed};
    for (int step = 0;; ++step) {
        const UtcTime time = start + std::chrono::minutes{step - static_cast<int>(random() % 3)};
        const auto path = testing::commit_sized(*store, random() % 2 == 0 ? "A" : "B", time,
                                                1 + static_cast<int>(random() % 8), step);
        if (!path) {
            std::fprintf(stderr, "%s\n", path.error().message.c_str());
            return 1;
        }
        if (step == 0) std::ofstream(begun) << "begun";
        if (random() % 10 == 0) store->roll();
    }
}

int read(const fs::path& cache, const fs::path& stop) {
    std::size_t whole = 0;
    while (!fs::exists(stop)) {
        const auto store = cache::StoreReader::open(cache);
        if (!store) return 1;
        for (const cache::StoreEntry& entry : testing::all_grids(*store)) {
            const auto file = cache::GridFile::open(entry.path);
            if (!file && file.error().code == ErrorCode::not_found) continue;  // evicted meanwhile
            const Status good = file ? file->verify() : Status(pass_on(file));
            if (!good) {
                std::fprintf(stderr, "%s\n", good.error().message.c_str());
                return 1;
            }
            whole += grid::to_dense(file->view()).values.empty() ? 0 : 1;
        }
    }
    return whole > 0 ? 0 : 2;
}

}  // namespace

int main(int argc, char** argv) {
    const std::string what = argc > 1 ? argv[1] : "";
    if (what == "write" && argc == 6) {
        return write(argv[2], std::strtoull(argv[3], nullptr, 10),
                     static_cast<unsigned>(std::atoi(argv[4])), argv[5]);
    }
    if (what == "read" && argc == 4) return read(argv[2], argv[3]);
    return 64;
}
