# Installs the documents. Links that lead to files of the source tree become their names, because those files are not
# installed; links to the headers lead to the installed ones. Needs: source, documents, headers (folders, absolute).

# Links to headers, then other links out of the documents. An image is no link: all images are installed.
function(install_document name)
  file(READ ${source}/${name} text)
  get_filename_component(folder ${documents}/${name} DIRECTORY)
  file(RELATIVE_PATH to_headers ${folder} ${headers})
  string(REGEX REPLACE "\\]\\((\\.\\./)*include/tumble/([^)]*)\\)" "](${to_headers}/tumble/\\2)" text "${text}")
  set(link "\\[([^]]*)\\]\\((\\.\\./)*((assets|bench|cmake|course|scripts|shaders|src|tests|web|action\\.yml)(/[^)]*)?)\\)")
  string(REGEX REPLACE "${link}" "\\1 (source tree: \\3)" text "${text}")
  file(WRITE ${documents}/${name} "${text}")
endfunction()

file(GLOB_RECURSE pages RELATIVE ${source} ${source}/docs/*.md)
foreach(name README.md CHANGELOG.md CONTRIBUTING.md ${pages})
  install_document(${name})
endforeach()
