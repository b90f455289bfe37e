// Sentences about many things, each said once.

/** "a.csv and 2 more: time in seconds", in the order in which they first come. */
export function sameWords(all: readonly { readonly name: string; readonly sentences: readonly string[] }[]): string[] {
  const names = new Map<string, string[]>();
  for (const { name, sentences } of all)
    for (const one of new Set(sentences)) names.set(one, [...(names.get(one) ?? []), name]);
  return [...names].map(([sentence, of]) => `${of[0]}${of.length > 1 ? ` and ${of.length - 1} more` : ""}: ${sentence}`);
}
