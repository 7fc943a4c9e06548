# cpack runs this on the staged tree. It writes what Debian policy demands of a package and no install rule writes.
set(share ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/share)
if(NOT EXISTS ${share})
  file(GLOB share ${CPACK_TEMPORARY_DIRECTORY}/*/usr/share)
endif()
set(folder ${share}/doc/${CPACK_PACKAGE_NAME})
file(MAKE_DIRECTORY ${folder})

# The copyright file is the head of LICENSE, since every Debian system has the text of the license itself.
file(READ ${CPACK_GONIOCHROME_LICENSE} license)
string(REGEX REPLACE "\n---------.*" "\n" head "${license}")
file(WRITE ${folder}/copyright
     "${head}\nOn Debian systems the full text of the GNU General Public License version 3 is in "
     "/usr/share/common-licenses/GPL-3.\n")

string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${folder}/changelog
     "${CPACK_PACKAGE_NAME} (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium\n\n"
     "  * Version ${CPACK_PACKAGE_VERSION}.\n\n"
     " -- ${CPACK_PACKAGE_CONTACT}  ${now}\n")

# With a umask of 002, the group may write to the tree that a build makes, but a package must not have such files.
execute_process(COMMAND chmod -R go-w ${share} COMMAND_ERROR_IS_FATAL ANY)

file(GLOB pages ${share}/man/man*/*.[1-9])
execute_process(COMMAND gzip -9nf ${folder}/changelog ${pages} COMMAND_ERROR_IS_FATAL ANY)
