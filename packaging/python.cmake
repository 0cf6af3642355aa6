# Makes the Python package as a wheel (target wheel, in packaging/wheel of the build; see python/setup.py) and as a
# Debian package (target python-package), python3-stormcellar_VERSION_ARCHITECTURE.deb.
add_custom_target(wheel
  COMMAND ${CMAKE_COMMAND} -E env STORMCELLAR_LIBRARY=$<TARGET_FILE:stormcellar_shared>
    /usr/bin/python3 -m pip wheel --quiet --no-deps --no-build-isolation
    -w ${CMAKE_CURRENT_BINARY_DIR}/wheel ${PROJECT_SOURCE_DIR}/python
  VERBATIM)

# The component python has the package for Debian's Python. The library is in the package's own directory, because no
# other package uses it.
set(modules lib/python3/dist-packages)
install(TARGETS stormcellar_shared LIBRARY DESTINATION ${modules}/stormcellar NAMELINK_SKIP
  COMPONENT python EXCLUDE_FROM_ALL)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/stormcellar DESTINATION ${modules}
  COMPONENT python EXCLUDE_FROM_ALL FILES_MATCHING PATTERN "*.py" PATTERN "py.typed"
  PATTERN "__pycache__" EXCLUDE)
# xarray finds the engine by this metadata.
set(metadata ${modules}/stormcellar-${PROJECT_VERSION}.dist-info)
configure_file(debian/python3/METADATA.in METADATA @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/METADATA debian/python3/entry_points.txt
  DESTINATION ${metadata} COMPONENT python EXCLUDE_FROM_ALL)
stormcellar_debian_documents(python python3-stormcellar)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/examples
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/python3-stormcellar COMPONENT python EXCLUDE_FROM_ALL
  FILES_MATCHING PATTERN "*.py")

configure_file(debian/python3/CPackPython.cmake.in ${PROJECT_BINARY_DIR}/CPackPython.cmake @ONLY)
add_custom_target(python-package
  COMMAND ${CMAKE_CPACK_COMMAND} --config ${PROJECT_BINARY_DIR}/CPackPython.cmake -B ${PROJECT_BINARY_DIR}
  DEPENDS stormcellar_shared VERBATIM)
