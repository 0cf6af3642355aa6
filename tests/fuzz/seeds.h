// tests/fuzz/seeds.h -- makes the small files from which the fuzzers start. The files never contain
// real data.
#pragma once

#include <string>
#include <vector>

#include "tests/level2/wire.h"

namespace stormcellar::fuzz {

struct Seed {
    std::string name;
    level2::wire::Bytes bytes;
};

[[nodiscard]] std::vector<Seed> container_seeds();
[[nodiscard]] std::vector<Seed> live_seeds();
[[nodiscard]] std::vector<Seed> messages_seeds();
[[nodiscard]] std::vector<Seed> compress_seeds();
[[nodiscard]] std::vector<Seed> archive_seeds();
[[nodiscard]] std::vector<Seed> bunzip_seeds();
[[nodiscard]] std::vector<Seed> grid_file_seeds();
[[nodiscard]] std::vector<Seed> request_seeds();
[[nodiscard]] std::vector<Seed> call_seeds();
[[nodiscard]] std::vector<Seed> shape_seeds();

}  // namespace stormcellar::fuzz
