# usage: zsh zsh_completes.zsh PROGRAM FOLDER WORDS
# Types WORDS and the tabulator key into a zsh that finds the completion in FOLDER, and prints <what it completed>.
zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell "unset zle_bracketed_paste; fpath=('$2' \$fpath); autoload -Uz compinit; compinit -u -D"
# Only the completion itself runs the program.
zpty -w shell "imunoise() { if [[ \$* == 'drivers --names' ]]; then '$1' \$*; else print -r -- \"LINE<\$*>\"; fi }"
# What is typed is echoed, and must not look like the answer.
zpty -w shell "print REA''DY"
while zpty -r shell line; do [[ $line == *READY* ]] && break; done
zpty -w -n shell "imunoise $3"$'\t\n'
zpty -w shell "print DO''NE"
while zpty -r shell line; do
  [[ $line == *LINE\<*\>* && $line != *print* ]] && print -r -- "<${${line#*LINE<}%>*}>"
  [[ $line == *DONE* ]] && break
done
zpty -d shell
