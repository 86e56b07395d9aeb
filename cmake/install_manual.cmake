# Installs the manual pages and the completions of shells. The installed program writes them, so that they fit it and a build
# costs nothing more. Needs: tumble (the program), man, data (folders of the prefix, absolute).

set(root "$ENV{DESTDIR}")
# The folder that zsh searches is another one for packages.
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(zsh ${data}/zsh/vendor-completions/_tumble)
else()
  set(zsh ${data}/zsh/site-functions/_tumble)
endif()
set(bash ${data}/bash-completion/completions/tumble)
set(fish ${data}/fish/vendor_completions.d/tumble.fish)

message(STATUS "Installing: ${root}${man}/man1")
execute_process(COMMAND ${tumble} man-pages "${root}${man}/man1" COMMAND_ERROR_IS_FATAL ANY)
file(GLOB pages RELATIVE "${root}${man}" "${root}${man}/man1/tumble*.1")
list(TRANSFORM pages PREPEND ${man}/)
foreach(shell bash zsh fish)
  message(STATUS "Installing: ${root}${${shell}}")
  execute_process(COMMAND ${tumble} completion ${shell} OUTPUT_VARIABLE script COMMAND_ERROR_IS_FATAL ANY)
  file(WRITE "${root}${${shell}}" "${script}")
endforeach()
list(APPEND CMAKE_INSTALL_MANIFEST_FILES ${pages} ${bash} ${zsh} ${fish})
