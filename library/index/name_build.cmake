# Writes OUTPUT, which names this build by the hash of the files that are listed in LIST: those that decide what a
# material reads as. So the command line and the library for programs, which are linked apart, know each other's indexes.
file(STRINGS ${LIST} objects)
set(hashes)
foreach(object IN LISTS objects)
  file(SHA256 ${object} hash)
  string(APPEND hashes ${hash})
endforeach()
string(SHA256 name "${hashes}")
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[namespace wale {
extern const char* const name_of_build;
const char* const name_of_build = "@name@";
}  // namespace wale
]] @ONLY)
