// bunzip/paths.h -- the ways in which a machine can decompress, and the choice among them.
//
// All paths give the same bytes. The usual path is the fastest path that this machine supports,
// unless the environment variable STORMCELLAR_BUNZIP names another path. A path set by
// set_usual_path() overrides both.
//
// Threads   Any thread may call every function.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace stormcellar::bunzip {

enum class Path : std::uint8_t {
    libbz2,  // libbz2 does everything
    plain,   // C++ for any machine
    avx2,    // x86 with AVX2, BMI2 and PCLMULQDQ
    avx512,  // x86 with AVX-512 up to VBMI2 (Ice Lake, Zen 4 and later)
};
inline constexpr std::array all_paths = {Path::libbz2, Path::plain, Path::avx2, Path::avx512};

[[nodiscard]] std::string_view name_of(Path path);
// Finds a path by its name. Returns none if no path has this name.
[[nodiscard]] std::optional<Path> path_named(std::string_view name);
[[nodiscard]] bool is_available(Path path);
[[nodiscard]] Path fastest_path();

// Returns the default path: the path from set_usual_path(), else the path named in
// STORMCELLAR_BUNZIP, else the fastest. A name that is unknown, or of a path that this machine
// lacks, is ignored. The environment is read once.
[[nodiscard]] Path usual_path();
// Sets the usual path. Returns false and changes nothing if this machine lacks the path.
bool set_usual_path(Path path);

}  // namespace stormcellar::bunzip
