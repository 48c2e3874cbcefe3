# What CPack runs between installing the components into its staging folders and packing them: what a Debian package has
# otherwise than `cmake --install` leaves it. Debian Policy 12 (documentation), 10.5 (links).
cmake_policy(VERSION 3.25)

# compress(FILE...): by gzip without a time, so that the same input gives the same package. Links to pages follow.
function(compress)
  foreach(file ${ARGN})
    if(IS_SYMLINK "${file}")
      file(READ_SYMLINK "${file}" target)
      file(REMOVE "${file}")
      file(CREATE_LINK "${target}.gz" "${file}.gz" SYMBOLIC)
    else()
      execute_process(COMMAND gzip --best --no-name "${file}" COMMAND_ERROR_IS_FATAL ANY)
    endif()
  endforeach()
endfunction()

# Debian's changelog: which upstream version it is, with a link to what changed. Its date is that of CHANGELOG.md.
function(write_changelog package folder)
  file(TIMESTAMP "${CPACK_KENAF_SOURCE}/CHANGELOG.md" date "%a, %d %b %Y %H:%M:%S +0000" UTC)
  string(REGEX REPLACE "-[^-]*$" "" upstream "${CPACK_KENAF_VERSION}")
  file(WRITE "${folder}/changelog.Debian"
    "kenaf (${CPACK_KENAF_VERSION}) unstable; urgency=medium\n\n"
    "  * Version ${upstream}, as its changelog describes it.\n\n"
    " -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
  file(COPY_FILE "${CPACK_KENAF_SOURCE}/CHANGELOG.md" "${folder}/changelog")
  compress("${folder}/changelog.Debian" "${folder}/changelog")
endfunction()

foreach(component ${CPACK_COMPONENTS_ALL})
  string(TOUPPER ${component} key)
  set(package "${CPACK_DEBIAN_${key}_PACKAGE_NAME}")
  set(root "${CPACK_TEMPORARY_DIRECTORY}/${component}/usr")
  set(documents "${root}/share/doc/${package}")

  file(GLOB_RECURSE pages "${root}/share/man/*")
  compress(${pages})
  write_changelog(${package} "${documents}")
  # What lintian(1) warns of and is meant so, with the reason: of every package, and of this one.
  foreach(overrides every-package ${package})
    set(overrides "${CPACK_KENAF_SOURCE}/cmake/debian/${overrides}.lintian-overrides")
    if(EXISTS "${overrides}")
      file(READ "${overrides}" text)
      file(APPEND "${root}/share/lintian/overrides/${package}" "${text}")
    endif()
  endforeach()

  # zsh looks for the functions of packages elsewhere than for those of the machine (README.Debian of zsh-common).
  if(EXISTS "${root}/share/zsh/site-functions")
    file(RENAME "${root}/share/zsh/site-functions" "${root}/share/zsh/vendor-completions")
  endif()
  # Modules of Python are in one folder for all minor versions, whose names say which one a module is for; below /usr/local
  # the interpreter looks in the folder of its own version alone (Debian Python Policy 2.5).
  file(GLOB python_folder "${root}/lib/python3.*")
  if(python_folder)
    file(RENAME "${python_folder}" "${root}/lib/python3")
  endif()
  # The page's three.js is Debian's own, by a link to what Depends brings.
  if(EXISTS "${root}/share/kenaf/three")
    file(REMOVE_RECURSE "${root}/share/kenaf/three")
    file(CREATE_LINK ../javascript/three "${root}/share/kenaf/three" SYMBOLIC)
  endif()
endforeach()

# README.md's name for what Debian calls copyright.
set(license "${CPACK_TEMPORARY_DIRECTORY}/programs/usr/share/doc/kenaf/LICENSE")
if(EXISTS "${license}")
  file(REMOVE "${license}")
  file(CREATE_LINK copyright "${license}" SYMBOLIC)
endif()
