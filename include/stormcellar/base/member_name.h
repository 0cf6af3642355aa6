// stormcellar/base/member_name.h -- paths that name members of archives, such as
// "DIR/a.tar!KTLX20170101_030027_V06".
//
// A '!' in a path proves nothing, because names of files may contain it, too. The caller must check
// that the archive exists.
//
// Threads   Pure functions.
// Errors    None.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace stormcellar {

inline constexpr char member_mark = '!';

struct MemberName {
    std::filesystem::path archive;
    std::string member;
};

// Returns all ways to split the path at a '!' into an archive and a member, the shortest archive
// first. Returns an empty list if there are none.
[[nodiscard]] inline std::vector<MemberName> member_names_in(const std::filesystem::path& path) {
    std::vector<MemberName> names;
    const std::string& text = path.native();
    for (std::size_t at = text.find(member_mark); at != std::string::npos;
         at = text.find(member_mark, at + 1)) {
        if (at > 0 && at + 1 < text.size())
            names.push_back({text.substr(0, at), text.substr(at + 1)});
    }
    return names;
}

// Returns the path that names a member of an archive.
[[nodiscard]] inline std::filesystem::path member_path(const std::filesystem::path& archive,
                                                       const std::string& member) {
    return archive.native() + member_mark + member;
}

}  // namespace stormcellar
