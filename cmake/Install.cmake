# Installs the CMake package. find_package(stormcellar COMPONENTS level2) then provides stormcellar::level2 and
# the targets that it links.
include(CMakePackageConfigHelpers)
set(STORMCELLAR_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/stormcellar)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/stormcellarConfig.cmake.in
  ${PROJECT_BINARY_DIR}/stormcellarConfig.cmake INSTALL_DESTINATION ${STORMCELLAR_CMAKE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/stormcellarConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
# List the rooms, each after the rooms that it links, and the targets that each room links.
get_property(rooms GLOBAL PROPERTY STORMCELLAR_ROOMS)
set(facts "set(stormcellar_rooms ${rooms})\n")
foreach(room IN LISTS rooms)
  get_property(links GLOBAL PROPERTY STORMCELLAR_LINKS_OF_${room})
  # Debian's module for GeographicLib gives a path, not a target.
  list(TRANSFORM links REPLACE "^.*/libGeographic.*$" GeographicLib)
  string(APPEND facts "set(stormcellar_links_of_${room} ${links})\n")
  install(EXPORT stormcellar-${room} NAMESPACE stormcellar:: DESTINATION ${STORMCELLAR_CMAKE_DIR}
    COMPONENT development)
endforeach()
file(WRITE ${PROJECT_BINARY_DIR}/stormcellarRooms.cmake "${facts}")
install(FILES ${PROJECT_BINARY_DIR}/stormcellarConfig.cmake
  ${PROJECT_BINARY_DIR}/stormcellarRooms.cmake
  ${PROJECT_BINARY_DIR}/stormcellarConfigVersion.cmake
  ${PROJECT_SOURCE_DIR}/cmake/Dependencies.cmake
  DESTINATION ${STORMCELLAR_CMAKE_DIR} COMPONENT development)
# Install every document, so that no link between documents is broken.
install(FILES README.md CHANGELOG.md CITATION.cff CONTRIBUTING.md GLOSSARY.md SECURITY.md
  DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES bunzip/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/bunzip)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
# The Debian package leaves out LICENSE, because its copyright file has the license.
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)
# These scenes are for `stormcellar frame` and `stormcellar loop`.
install(FILES scenes/picture-midwest.toml scenes/picture-regional.toml scenes/picture-section.toml scenes/picture-supercell.toml
  scenes/fly-supercell.toml scenes/storm-colours.toml scenes/clear-air-colours.toml DESTINATION ${CMAKE_INSTALL_DATADIR}/stormcellar/scenes)
# Until the next release, the old paths of headers that moved within their room can still be included.
foreach(moved animation/animation products/product volume/integration volume/light)
  get_filename_component(name ${moved} NAME)
  file(WRITE ${PROJECT_BINARY_DIR}/old-headers/render/${moved}.h
    "// This header moved to stormcellar/render/${name}.h. The next release removes the old path.\n"
    "#include \"stormcellar/render/${name}.h\"\n")
endforeach()
foreach(old colour_table colour/colour_table)
  file(WRITE ${PROJECT_BINARY_DIR}/old-headers/render/${old}.h
    "// This header moved to stormcellar/render/color_table.h. The next release removes the old path.\n"
    "#include \"stormcellar/render/color_table.h\"\n"
    "namespace stormcellar::render { using ColourTable = ColorTable; }\n")
endforeach()
install(DIRECTORY ${PROJECT_BINARY_DIR}/old-headers/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/stormcellar
  COMPONENT development)
