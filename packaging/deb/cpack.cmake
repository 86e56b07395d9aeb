# CPack's settings for the Debian package. scripts/package calls cpack with environment variables: TUMBLE_STAGE (the
# installed tree), TUMBLE_VERSION, TUMBLE_REVISION, TUMBLE_MAINTAINER, TUMBLE_LIBRARIES (the
# dependencies of dpkg-shlibdeps), TUMBLE_CONTROL (a folder with more control files).
#
# One package holds the program, the library and its headers. The library's interface changes with each version before 1.0 and
# has to fit the headers, nothing in Debian depends on it, and a farm's node is set up with one file. The development files are
# under 1 % of it.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME tumble)
set(CPACK_PACKAGE_FILE_NAME tumble)   # of working folders
set(CPACK_PACKAGE_VERSION $ENV{TUMBLE_VERSION})
set(CPACK_DEBIAN_PACKAGE_RELEASE $ENV{TUMBLE_REVISION})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_INSTALLED_DIRECTORIES "$ENV{TUMBLE_STAGE};/")
set(CPACK_PACKAGING_INSTALL_PREFIX /)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES OFF)   # done
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER $ENV{TUMBLE_MAINTAINER})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "headless renderer of rigid-body animation clips")
set(CPACK_PACKAGE_DESCRIPTION
"Tumble simulates rigid bodies that fall, bounce and come to rest, from scene
files in TOML, and draws them without a screen or a graphics card. It writes
clips (MP4, WebM, GIF), PNG frames, exact depth and segmentation maps, tables
of numbers, plots, glTF files and web pages. The same scene gives the same
motion on each x86-64 processor, and the same frames with any number of
processes.
.
The package holds the program, demo scenes, and a C++ library with its
headers.")

# CPack's own search for linked libraries would add scripts that call ldconfig (Debian has a trigger for it), and asks "file"
# about each of the files.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA $ENV{TUMBLE_CONTROL}/shlibs $ENV{TUMBLE_CONTROL}/triggers)
set(CPACK_DEBIAN_PACKAGE_DEPENDS
  "$ENV{TUMBLE_LIBRARIES}"   # linked ones; those below are opened by name
  "libosmesa6 (>= 20) | libegl-mesa0"    # draws on the CPU
  "libpangocairo-1.0-0 (>= 1.50)"   # plots and text, and with it Cairo
  "fonts-inter")          # texts in frames: another font would give other pixels on each machine
list(JOIN CPACK_DEBIAN_PACKAGE_DEPENDS ", " CPACK_DEBIAN_PACKAGE_DEPENDS)
# Clips need ffmpeg; simulations, frames, plots and pages without films do not, and it is larger than all the rest.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS ffmpeg)
# --gl egl; the compiler of lessons; what loads the completions.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libegl1, libgl1-mesa-dri, nodejs (>= 18), bash-completion")
