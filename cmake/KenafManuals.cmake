# Manual pages and completion, made of what the programs and the public header say of themselves, so that they never
# differ. Programs that are built for another machine cannot be asked, and those of a sanitizer are not installed.
if(NOT CMAKE_CROSSCOMPILING AND NOT KENAF_SANITIZE)
  find_program(KENAF_HELP2MAN help2man DOC "Makes the programs' manual pages")
  find_program(KENAF_PYTHON3 python3 DOC "Makes the library's manual pages, and the programs' completion")
endif()
if(NOT KENAF_HELP2MAN OR NOT KENAF_PYTHON3)
  message(STATUS "No manual pages or completion: no help2man or python3, or the programs are not for this machine's users")
endif()
set(manual_folder "${PROJECT_BINARY_DIR}/share/man")  # where `man` looks for the pages of the programs in bin/
set(completion_folder "${PROJECT_BINARY_DIR}/completion")
file(MAKE_DIRECTORY "${manual_folder}/man1" "${completion_folder}/bash" "${completion_folder}/zsh")

# kenaf_manual(NAME "what it is" INCLUDE snippet... [COMPONENT c]): the program's manual page, and its completion in bash
# and zsh. Beside its --help the page has what docs/manual/SNIPPET.h2m say: sections in the format of help2man(1).
function(kenaf_manual name description)
  cmake_parse_arguments(MANUAL "" "COMPONENT" "INCLUDE" ${ARGN})
  if(NOT MANUAL_COMPONENT)
    set(MANUAL_COMPONENT programs)
  endif()
  if(KENAF_HELP2MAN)
    # help2man asks one program, and takes the page's name from its file
    set(asked "${CMAKE_CURRENT_BINARY_DIR}/manual/${name}")
    set(whole_help "${PROJECT_SOURCE_DIR}/cmake/whole-help.sh")
    file(GENERATE OUTPUT "${asked}" CONTENT "#!/bin/sh\nexec '${whole_help}' '$<TARGET_FILE:${name}>'\n"
      FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
    list(TRANSFORM MANUAL_INCLUDE REPLACE "(.+)" "${PROJECT_SOURCE_DIR}/docs/manual/\\1.h2m" OUTPUT_VARIABLE snippets)
    list(TRANSFORM snippets PREPEND "--include=" OUTPUT_VARIABLE includes)
    set(page "${manual_folder}/man1/${name}.1")
    add_custom_command(OUTPUT "${page}"
      COMMAND "${KENAF_HELP2MAN}" --no-info "--version-string=${PROJECT_VERSION}" "--name=${description}"
        --locale=C.UTF-8 ${includes} "--output=${page}" "${asked}"
      DEPENDS ${name} "${asked}" "${whole_help}" ${snippets} COMMENT "Manual page of ${name}" VERBATIM)
    install(FILES "${page}" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT ${MANUAL_COMPONENT})
  endif()
  if(KENAF_PYTHON3)
    set(script "${PROJECT_SOURCE_DIR}/cmake/completion.py")
    set(bash "${completion_folder}/bash/${name}")
    set(zsh "${completion_folder}/zsh/_${name}")
    add_custom_command(OUTPUT "${bash}" "${zsh}"
      COMMAND "${KENAF_PYTHON3}" "${script}" bash "$<TARGET_FILE:${name}>" "${bash}"
      COMMAND "${KENAF_PYTHON3}" "${script}" zsh "$<TARGET_FILE:${name}>" "${zsh}"
      DEPENDS ${name} "${script}" COMMENT "Completion of ${name}" VERBATIM)
    install(FILES "${bash}" DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions"
      COMPONENT ${MANUAL_COMPONENT})
    install(FILES "${zsh}" DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/site-functions" COMPONENT ${MANUAL_COMPONENT})
  endif()
  add_custom_target(${name}.1 ALL DEPENDS ${page} ${bash} ${zsh})
endfunction()

# The library's pages: hrt(3), with a link for each function, and kenaf.toml(5).
if(KENAF_PYTHON3)
  set(script "${PROJECT_SOURCE_DIR}/cmake/header_manual.py")
  set(header "${PROJECT_SOURCE_DIR}/include/kenaf/hrt.h")
  set(guide "${PROJECT_SOURCE_DIR}/docs/user-guide.md")
  add_custom_command(OUTPUT "${manual_folder}/man3/hrt.3" "${manual_folder}/man5/kenaf.toml.5"
    COMMAND "${KENAF_PYTHON3}" "${script}" "${header}" "${guide}" "${PROJECT_VERSION}" "${manual_folder}"
    DEPENDS "${script}" "${header}" "${guide}" COMMENT "Manual pages of the library" VERBATIM)
  add_custom_target(hrt.3 ALL DEPENDS "${manual_folder}/man3/hrt.3")
  install(DIRECTORY "${manual_folder}/man3" DESTINATION "${CMAKE_INSTALL_MANDIR}" COMPONENT development)
  # of the data, as of which there is one, whatever interfaces of the library are installed
  install(FILES "${manual_folder}/man5/kenaf.toml.5" DESTINATION "${CMAKE_INSTALL_MANDIR}/man5" COMPONENT data)
endif()
