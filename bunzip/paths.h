// bunzip/paths.h -- the ways a machine can decompress: which there are, and which is taken.
//
// All give the same bytes. `fastest` is the best of the others that this machine has; the
// environment's STORMCELLAR_BUNZIP can name another, and set_usual_path() is above both.
// Thread contract: all functions are safe.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace stormcellar::bunzip {

enum class Path : std::uint8_t {
    libbz2,  // the library alone
    plain,   // any machine
    avx2,    // x86 with AVX2, BMI2 and PCLMULQDQ
    avx512,  // x86 with AVX-512 up to VBMI2 (Ice Lake, Zen 4 and later)
};
inline constexpr std::array all_paths = {Path::libbz2, Path::plain, Path::avx2, Path::avx512};

[[nodiscard]] std::string_view name_of(Path path);
// None where no path is called so.
[[nodiscard]] std::optional<Path> path_named(std::string_view name);
[[nodiscard]] bool is_available(Path path);
[[nodiscard]] Path fastest_path();

// What is used where none is asked for: set here, else named in STORMCELLAR_BUNZIP (what names no
// path, or one that this machine has not, is ignored), else the fastest.
[[nodiscard]] Path usual_path();
// False, and nothing is changed, where this machine has not got it.
bool set_usual_path(Path path);

}  // namespace stormcellar::bunzip
