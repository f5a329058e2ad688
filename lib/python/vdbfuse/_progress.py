# SPDX-License-Identifier: Apache-2.0
"""progress= takes a function of (step, share), tqdm itself, or one bar of it."""


def _of_bar(bar):
    """One bar over all steps, its description the running one."""
    bar.reset(total=1)

    def show(step, share):
        bar.set_description(step)
        bar.n = share
        bar.refresh()
    return show


def _of_bar_class(make):
    """A bar for each step."""
    bars = {}

    def show(step, share):
        if step not in bars:
            for bar in bars.values():
                bar.close()
            bars.clear()
            bars[step] = make(total=1, desc=step, bar_format="{desc}: {percentage:3.0f}%|{bar}| {elapsed}")
        bars[step].n = share
        bars[step].refresh()
        if share == 1:
            bars[step].close()
    return show


def function_of(progress):
    """What the extension module calls, or None."""
    if progress is None:
        return None
    is_bar = all(hasattr(progress, name) for name in ("set_description", "refresh", "reset"))
    if is_bar:
        return _of_bar_class(progress) if isinstance(progress, type) else _of_bar(progress)
    if not callable(progress):
        raise TypeError(f"progress: expected a function of (step, share), found {type(progress).__name__}")
    return progress
