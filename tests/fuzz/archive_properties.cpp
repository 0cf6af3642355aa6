#include <algorithm>
#include <filesystem>
#include <set>
#include <string>

#include "stormcellar/archive/archive_reader.h"
#include "tests/archive/archive_maker.h"
#include "tests/fuzz/properties.h"
#include "tests/fuzz/seeds.h"

namespace stormcellar::fuzz {

void check_archive(std::span<const std::byte> file) {
    archive::Limits limits;
    limits.members = 100;
    limits.member_bytes = std::uint64_t{1} << 20;
    limits.all_bytes = std::uint64_t{4} << 20;
    auto reader = archive::ArchiveReader::open(file, limits);
    if (!reader) return;
    std::set<std::string> names;
    std::uint64_t bytes = 0;
    while (const auto member = reader->next()) {
        const std::filesystem::path name{member->name};
        require(names.insert(member->name).second, "two members of one name");
        require(!member->name.empty() && !name.is_absolute(), "a name that leads out");
        require(std::find(name.begin(), name.end(), "..") == name.end(), "a name that leads out");
        require(member->bytes.size() <= limits.member_bytes, "a member beyond its limit");
        bytes += member->bytes.size();
    }
    require(bytes <= limits.all_bytes, "{} bytes in all", bytes);
    // Each inner archive may also have limits.members members.
    require(names.size() <= limits.members * limits.members, "{} members", names.size());
    require(!reader->next(), "a member behind the last");
}

std::vector<Seed> archive_seeds() {
    using archive::Kind;
    const std::vector<archive::Put> puts = {
        {"a", archive::bytes_of("first")},
        {"b/c", std::vector<std::byte>(3000)},
        {"link", {}, archive::Put::What::symlink, "a"},
        {"../out", archive::bytes_of("x")},
    };
    std::vector<Seed> seeds = {
        {"tar", make_archive(Kind::tar, puts)},
        {"tar_gz", make_archive(Kind::tar_gz, puts)},
        {"tar_bz2", make_archive(Kind::tar_bz2, puts)},
        {"tar_xz", make_archive(Kind::tar_xz, puts)},
        {"tar_zst", make_archive(Kind::tar_zst, puts)},
        {"zip", make_archive(Kind::zip, puts)},
    };
    seeds.push_back({"nested", make_archive(Kind::zip, {{"inner.tar", seeds.front().bytes}})});
    return seeds;
}

}  // namespace stormcellar::fuzz
