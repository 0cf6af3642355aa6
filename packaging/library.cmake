# Makes the Debian packages of the C interface (target library-package): libstormcellar0 has the library, and
# libstormcellar-dev its header, the link for compilers and the file for pkg-config.
file(RELATIVE_PATH library_to_prefix /usr/${CMAKE_INSTALL_LIBDIR}/pkgconfig /usr)
string(REGEX REPLACE "/$" "" library_to_prefix ${library_to_prefix})
configure_file(debian/library/stormcellar.pc.in stormcellar.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/stormcellar.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
  COMPONENT shared-development EXCLUDE_FROM_ALL)
stormcellar_debian_documents(shared libstormcellar0)
stormcellar_debian_documents(shared-development libstormcellar-dev)

configure_file(debian/library/CPackLibrary.cmake.in ${PROJECT_BINARY_DIR}/CPackLibrary.cmake @ONLY)
add_custom_target(library-package
  COMMAND ${CMAKE_CPACK_COMMAND} --config ${PROJECT_BINARY_DIR}/CPackLibrary.cmake -B ${PROJECT_BINARY_DIR}
  DEPENDS stormcellar_shared VERBATIM)
