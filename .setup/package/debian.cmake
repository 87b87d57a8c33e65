# `cpack -G DEB` makes Debian packages of the installed components. Configure with -DCMAKE_INSTALL_PREFIX=/usr, so that
# the libraries lie where Debian has them.
set(CPACK_PACKAGE_NAME wale)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "The Wale developers <wale@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE "")
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_COMPONENTS_ALL)

set(about "Wale is a language for how things feel, its compiler, and the runtime that
plays its programs on force-feedback joysticks.")

# debian_package(COMPONENT NAME SECTION SUMMARY TEXT [RELATION VALUE]...)
macro(debian_package component name section summary text)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SHLIBDEPS ON)
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}\n${about}\n.\n${text}")
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${summary}\n${about}\n.\n${text}")
  set(relations ${ARGN})
  while(relations)
    list(POP_FRONT relations relation value)
    set(CPACK_DEBIAN_${upper}_PACKAGE_${relation} "${value}")
  endwhile()
  install(FILES ${CMAKE_CURRENT_SOURCE_DIR}/copyright ${CMAKE_CURRENT_BINARY_DIR}/changelog.gz
          DESTINATION share/doc/${name} COMPONENT ${component})
endmacro()

set(this "(= ${PROJECT_VERSION})")
configure_file(changelog changelog COPYONLY)
execute_process(COMMAND gzip -9nkf changelog WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR} COMMAND_ERROR_IS_FATAL ANY)

# What who links a library then depends on, and the trigger by which the system finds it. (CPack would call ldconfig.)
function(write_library_control component name package)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/control/${component})
  file(WRITE ${folder}/shlibs "${name} ${wale_abi} ${package} (>= ${PROJECT_VERSION})\n")
  file(WRITE ${folder}/triggers "activate-noawait ldconfig\n")
endfunction()
write_library_control(runtime libwale-runtime libwale-runtime1)
write_library_control(compiler libwale libwale1)
write_library_control(calibration libwale-calibration libwale-calibration1)
set(control ${CMAKE_CURRENT_BINARY_DIR}/control)

# A package of its own, and not a part of the library's: packages of two versions of a library can be installed together.
debian_package(keeper wale-keeper misc "lets a force-feedback joystick go when its program cannot"
  "This package has the program wale-keeper, which Wale's runtime starts for each
joystick, and the udev rule by which a user who is logged in may use the
declared joysticks.")
debian_package(runtime libwale-runtime1 libs "runtime of the haptics language Wale"
  "This package has the library that runs patch programs: stage, guards, devices
and recordings."
  DEPENDS "wale-keeper (>= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${control}/runtime/shlibs ${control}/runtime/triggers)
set(all_development "libwale-runtime1 ${this}, libglm-dev")
if(WALE_COMPILER)
  debian_package(compiler libwale1 libs "materials of the haptics language Wale by name"
    "This package has the library that finds and compiles materials and levels of
percepts. Materials with pictures also need the decoder of the package wale."
    DEPENDS "libwale-runtime1 ${this}" RECOMMENDS wale)
  set(CPACK_DEBIAN_COMPILER_PACKAGE_CONTROL_EXTRA ${control}/compiler/shlibs ${control}/compiler/triggers)
  debian_package(calibration libwale-calibration1 libs "logs of sessions with people who feel materials"
    "This package has the library that writes and reads the log of a session: who
felt what, and what they answered."
    DEPENDS "libwale-runtime1 ${this}")
  set(CPACK_DEBIAN_CALIBRATION_PACKAGE_CONTROL_EXTRA ${control}/calibration/shlibs ${control}/calibration/triggers)
  string(APPEND all_development ", libwale1 ${this}, libwale-calibration1 ${this}")
  debian_package(command wale utils "language for how things feel"
    "This package has the command line, which checks, describes, compares, draws
and feels materials, and the shipped library of materials."
    DEPENDS "wale-keeper (>= ${PROJECT_VERSION})" RECOMMENDS wale-doc SUGGESTS libwale-dev)
  if(TARGET wale-sandpaper)
    debian_package(sandpaper wale-sandpaper utils "workspace for materials that are felt"
      "This package has the window in which materials are laid out, felt with a
force-feedback joystick or seen with the mouse, and changed."
      DEPENDS "wale ${this}" SUGGESTS "speech-dispatcher, cups")
  endif()
  if(EXISTS ${PROJECT_SOURCE_DIR}/library/python/wale)
    debian_package(python python3-wale python "haptics language Wale from Python"
      "This package has the Python module wale."
      DEPENDS "python3, python3-cffi, python3-numpy, libwale1 ${this}" ARCHITECTURE all)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS OFF)
  endif()
endif()
debian_package(pages wale-doc doc "pages and examples of the haptics language Wale"
  "This package has the pages about the language, the library, the interfaces and
the formats of files, and programs to begin from."
  SUGGESTS "wale, libwale-dev" ARCHITECTURE all)
set(CPACK_DEBIAN_PAGES_PACKAGE_SHLIBDEPS OFF)
debian_package(development libwale-dev libdevel "headers and libraries of the haptics language Wale"
  "This package has what programs are built with: headers, static libraries, the
CMake package Wale, and wale.pc and wale-runtime.pc for pkg-config."
  DEPENDS "${all_development}" RECOMMENDS wale-doc SUGGESTS "libusb-1.0-0-dev, libfmt-dev, libkissfft-dev, libutf8proc-dev, nettle-dev, libexpat1-dev, libsqlite3-dev, libpq-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
# The libraries refer to each other before they are installed.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR})
include(CPack)
