/** As the ref of an element: it has the focus once it is there. */
export const focus = (element: HTMLElement | null): void => element?.focus();
