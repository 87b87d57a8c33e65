# The pages for users, as they are installed: in their folders, so that a link from one to another leads there. A link to a
# file that is installed elsewhere leads to that place; one to a file that is not installed becomes plain text.
set(pages README.md runtime/README.md runtime/C_INTERFACE.md runtime/record/RECORDING.md
          runtime/workspace/WORKSPACE_FILE.md schema/LANGUAGE.md schema/PATCH_PROGRAM.md schema/SECURITY.md
          library/README.md library/CURATORS_DAY.md library/CONTRIBUTING.md library/std/README.md
          library/python/README.md calibration/README.md calibration/RESEARCHERS_AFTERNOON.md
          calibration/session/SESSION_LOG.md compiler/README.md compiler/cpp/README.md compiler/image/README.md
          examples/README.md examples/sandpaper/README.md examples/learn/README.md examples/learn/RECIPES.md
          examples/learn/FORCES.md)
if(NOT WALE_COMPILER)
  list(FILTER pages INCLUDE REGEX "^(runtime|schema/[PS])")
endif()
set(page_folder ${CMAKE_CURRENT_BINARY_DIR}/pages)

# Where a file of the project is installed, seen from the prefix; nothing if it is not.
function(installed_place file place)
  set(found "")
  if(file IN_LIST pages OR file MATCHES "^examples(/.*)?$")
    set(found ${CMAKE_INSTALL_DOCDIR}/${file})
  elseif(file MATCHES "^(schema|runtime|library|calibration)/include/(.*)$")
    set(found ${CMAKE_INSTALL_INCLUDEDIR}/${CMAKE_MATCH_2})
  elseif(NOT WALE_COMPILER)
    set(found "")
  elseif(file MATCHES "^(library|calibration)(/[a-z]+)*$" OR file MATCHES "^(library|calibration|schema)/.*[.](wale|csv|png)$")
    set(found ${CMAKE_INSTALL_DATADIR}/wale/${file})
  elseif(file STREQUAL "runtime/device/hid_pid/70-wale.rules")
    set(found lib/udev/rules.d/70-wale.rules)
  endif()
  set(${place} "${found}" PARENT_SCOPE)
endfunction()

# Writes a page with the links that it has when it is installed.
function(write_page page)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${page})
  file(READ ${PROJECT_SOURCE_DIR}/${page} rest)
  cmake_path(GET page PARENT_PATH folder)
  set(text "")
  while(TRUE)
    string(FIND "${rest}" "](" at)
    if(at EQUAL -1)
      break()
    endif()
    string(SUBSTRING "${rest}" 0 ${at} before)
    string(SUBSTRING "${rest}" ${at} -1 rest)
    string(APPEND text "${before}")
    if(NOT rest MATCHES "^\\]\\(([A-Za-z0-9_./-]+)(#[^)]*)?\\)")  # a link within the page, to the web, or no link
      string(APPEND text "](")
      string(SUBSTRING "${rest}" 2 -1 rest)
      continue()
    endif()
    set(anchor "${CMAKE_MATCH_2}")
    string(LENGTH "${CMAKE_MATCH_0}" length)
    string(SUBSTRING "${rest}" ${length} -1 rest)
    cmake_path(SET target NORMALIZE "${folder}/${CMAKE_MATCH_1}")
    string(REGEX REPLACE "^/|/$" "" target "${target}")
    installed_place("${target}" place)
    if(place)
      cmake_path(RELATIVE_PATH place BASE_DIRECTORY ${CMAKE_INSTALL_DOCDIR}/${folder})
      string(APPEND text "](${place}${anchor})")
    else()
      string(FIND "${text}" "[" begin REVERSE)
      string(SUBSTRING "${text}" 0 ${begin} before)
      math(EXPR begin "${begin} + 1")
      string(SUBSTRING "${text}" ${begin} -1 words)
      set(text "${before}${words}")
    endif()
  endwhile()
  file(CONFIGURE OUTPUT ${page_folder}/${page} CONTENT "@text@@rest@" @ONLY)
endfunction()

foreach(page IN LISTS pages)
  write_page(${page})
endforeach()
install(DIRECTORY ${page_folder}/ DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT pages FILES_MATCHING PATTERN *.md)
# Programs to begin from.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT pages
        FILES_MATCHING PATTERN *.cpp PATTERN *.c PATTERN *.py PATTERN *.png PATTERN *.wale PATTERN CMakeLists.txt
        REGEX "sandpaper/.*(/|[.]cpp|[.]txt)$" EXCLUDE)  # the window is a package of its own
