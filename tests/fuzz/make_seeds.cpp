// make_seeds DIRECTORY -- writes the seeds of the fuzzers, one folder for each target.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "tests/fuzz/seeds.h"

namespace {

using stormcellar::fuzz::Seed;

void write(const std::filesystem::path& folder, const std::vector<Seed>& seeds) {
    std::filesystem::create_directories(folder);
    for (const Seed& seed : seeds) {
        std::ofstream file(folder / seed.name, std::ios::binary);
        file.exceptions(std::ios::failbit | std::ios::badbit);
        file.write(reinterpret_cast<const char*>(seed.bytes.data()),
                   static_cast<std::streamsize>(seed.bytes.size()));
        file.close();
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: make_seeds DIRECTORY\n", stderr);
        return 2;
    }
    try {
        const std::filesystem::path directory = argv[1];
        write(directory / "container", stormcellar::fuzz::container_seeds());
        write(directory / "live", stormcellar::fuzz::live_seeds());
        write(directory / "messages", stormcellar::fuzz::messages_seeds());
        write(directory / "compress", stormcellar::fuzz::compress_seeds());
        write(directory / "archive", stormcellar::fuzz::archive_seeds());
        write(directory / "bunzip", stormcellar::fuzz::bunzip_seeds());
        write(directory / "grid_file", stormcellar::fuzz::grid_file_seeds());
        write(directory / "request", stormcellar::fuzz::request_seeds());
        write(directory / "calls", stormcellar::fuzz::call_seeds());
        write(directory / "shapes", stormcellar::fuzz::shape_seeds());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "make_seeds: %s\n", error.what());
        return 1;
    }
    return 0;
}
