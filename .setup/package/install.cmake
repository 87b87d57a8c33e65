# What `cmake --install` installs, each part as a component: a Debian package is one of them (debian.cmake).
include(CMakePackageConfigHelpers)
set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Wale)
set(companion_folder ${CMAKE_INSTALL_LIBEXECDIR}/wale)
set(data_folder ${CMAKE_INSTALL_DATADIR}/wale)

# install_library(NAME COMPONENT): the shared library for those who run, the rest for those who build.
function(install_library name component)
  install(TARGETS ${name}_shared EXPORT Wale-${component}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${component} NAMELINK_COMPONENT development)
  # Debian's libraries name no folders. Only the installation knows the prefix: `--prefix` and CPack change it.
  get_target_property(version ${name}_shared VERSION)
  install(CODE "if(CMAKE_INSTALL_PREFIX STREQUAL \"/usr\")
    file(RPATH_REMOVE FILE \"\$ENV{DESTDIR}/usr/${CMAKE_INSTALL_LIBDIR}/lib${name}.so.${version}\")
  endif()" COMPONENT ${component})
  install(TARGETS ${name}_static EXPORT Wale-${component}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  install(EXPORT Wale-${component} NAMESPACE Wale:: DESTINATION ${config_folder} COMPONENT development)
  # Places are relative to the file, so that an installed tree may be moved.
  file(RELATIVE_PATH prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  configure_file(${name}.pc.in ${name}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
endfunction()

configure_package_config_file(WaleConfig.cmake.in WaleConfig.cmake INSTALL_DESTINATION ${config_folder})
write_basic_package_version_file(WaleConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/WaleConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/WaleConfigVersion.cmake
        DESTINATION ${config_folder} COMPONENT development)

# Public headers: all that lies in include/ of a folder.
function(install_headers)
  foreach(folder IN LISTS ARGN)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder}/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
            COMPONENT development FILES_MATCHING PATTERN *.hpp PATTERN *.h PATTERN *.def)
  endforeach()
endfunction()

include(pages.cmake)

install(TARGETS wale-c_runtime EXPORT Wale-runtime)
install_library(wale-runtime runtime)
install_headers(schema runtime)
install(TARGETS wale_keeper RUNTIME DESTINATION ${companion_folder} COMPONENT keeper)
install(FILES ${PROJECT_SOURCE_DIR}/runtime/device/hid_pid/70-wale.rules DESTINATION lib/udev/rules.d COMPONENT keeper)

if(WALE_COMPILER)
  install(TARGETS wale-c EXPORT Wale-compiler)
  install_library(wale compiler)
  install_library(wale-calibration calibration)
  install_headers(library calibration)
  install(TARGETS wale RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command)
  install(TARGETS wale-decoder RUNTIME DESTINATION ${companion_folder} COMPONENT command)
  install(TARGETS wale_images LIBRARY DESTINATION ${companion_folder} COMPONENT command)
  if(TARGET wale-sandpaper)
    install(TARGETS wale-sandpaper RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT sandpaper)
    install(FILES ${PROJECT_SOURCE_DIR}/examples/sandpaper/wale-sandpaper.desktop DESTINATION share/applications
            COMPONENT sandpaper)
  endif()
  # The binaries have these files inside; here they are for people to read and to begin from.
  file(GLOB_RECURSE files RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS
       ${PROJECT_SOURCE_DIR}/library/*.wale ${PROJECT_SOURCE_DIR}/library/*.csv ${PROJECT_SOURCE_DIR}/library/*.png
       ${PROJECT_SOURCE_DIR}/calibration/*.wale ${PROJECT_SOURCE_DIR}/calibration/*.csv ${PROJECT_SOURCE_DIR}/schema/*.wale)
  foreach(file IN LISTS files)
    cmake_path(GET file PARENT_PATH folder)
    install(FILES ${PROJECT_SOURCE_DIR}/${file} DESTINATION ${data_folder}/${folder} COMPONENT command)
  endforeach()
  install(FILES ${PROJECT_SOURCE_DIR}/library/wale.project DESTINATION ${data_folder}/library COMPONENT command)

  if(TARGET manual)
    # Debian's zsh looks elsewhere.
    set(zsh_folder share/zsh/site-functions)
    if(CMAKE_INSTALL_PREFIX STREQUAL "/usr" AND EXISTS /etc/debian_version)
      set(zsh_folder share/zsh/vendor-completions)
    endif()
    install(DIRECTORY ${manual}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT command FILES_MATCHING PATTERN *.1.gz)
    install(FILES ${manual}/wale.bash DESTINATION share/bash-completion/completions RENAME wale COMPONENT command)
    install(FILES ${manual}/_wale DESTINATION ${zsh_folder} COMPONENT command)
  endif()

  # The Python package, where there is one: it loads the shared library by its name.
  if(EXISTS ${PROJECT_SOURCE_DIR}/library/python/wale)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/library/python/wale DESTINATION lib/python3/dist-packages COMPONENT python
            FILES_MATCHING PATTERN *.py PATTERN *.pyi PATTERN py.typed PATTERN *.h PATTERN __pycache__ EXCLUDE)
  endif()
endif()
