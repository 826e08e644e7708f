// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** Sliders for parameters: the knob's travel, even or by decades, from the range that the server gives. */

import type { Parameter, ParameterValue } from "../client/state";
import type { Slider } from "./widgets";

/** A range that reaches this many times beyond the value is travelled by decades. */
const DECADES_FROM = 1000;
/** How far to both sides of the value it began with such a slider reaches. */
const DECADES = 3;
/** The lowest part of a travel by decades that stands for 0, where the range allows 0. */
const ZERO_SHARE = 0.04;
/** An even travel reaches this many times the value, where the range is much longer. */
const STRETCH = 4;
/** How far the slider of a value of 0 reaches where nobody says otherwise. */
const FROM_ZERO = 100;

export interface Travel {
  value(position: number): number;
  position(value: number): number;
}

/**
 * Returns how the knob travels.
 *
 * @param origin the value that the travel is laid around; it stays while one slides.
 * @param reach the part of the range that is worth a slider, where the value does not tell.
 */
export function travelOf(parameter: Parameter, origin: number, reach?: number): Travel {
  const low = parameter.min ?? Math.min(0, origin);
  const high = parameter.max ?? Infinity;
  const whole = parameter.type === "integer";
  if (!reach && !whole && origin > 0 && low >= 0 && high >= DECADES_FROM * origin) {
    return byDecades(Math.max(low, origin / 10 ** DECADES), Math.min(high, origin * 10 ** DECADES), low === 0);
  }
  const wanted = Math.max(reach ?? (origin === 0 ? FROM_ZERO : STRETCH * Math.abs(origin)), origin);
  return evenly(low, high > 2 * wanted || reach ? Math.min(high, wanted) : high, whole);
}

function evenly(low: number, high: number, whole: boolean): Travel {
  const span = high - low || 1;
  return {
    value: (position) => {
      const value = low + span * position;
      return whole ? Math.round(value) : Number(value.toPrecision(3));
    },
    position: (value) => Math.min(1, Math.max(0, (value - low) / span)),
  };
}

function byDecades(low: number, high: number, zero: boolean): Travel {
  const begin = zero ? ZERO_SHARE : 0;
  const span = Math.log(high / low);
  return {
    value: (position) => {
      if (position < begin) return 0;
      return Number((low * Math.exp((span * (position - begin)) / (1 - begin))).toPrecision(2));
    },
    position: (value) => {
      if (value <= 0) return 0;
      const share = Math.log(Math.min(high, Math.max(low, value)) / low) / span;
      return begin + share * (1 - begin);
    },
  };
}

export function formatted(value: number, unit: string): string {
  const digits =
    Math.abs(value) >= 1000 || Number.isInteger(value)
      ? String(Math.round(value))
      : String(Number(value.toPrecision(3)));
  return unit ? `${digits} ${unit}` : digits;
}

const origins = new Map<string, number>();

/** Returns a slider for a number among the parameters. */
export function parameterSlider(
  parameter: Parameter,
  label: string,
  commit: (parameter: Parameter, value: ParameterValue) => void,
  { zeroReads = "", reach }: { zeroReads?: string; reach?: number } = {},
): Slider {
  const value = Number(parameter.value);
  const origin = origins.get(parameter.name) ?? value;
  origins.set(parameter.name, origin);
  const travel = travelOf(parameter, origin, reach);
  return {
    kind: "slider",
    id: parameter.name,
    label,
    hint: parameter.description,
    position: travel.position(value),
    step: 0.02,
    text: (position) => {
      // Where the knob rests the value itself is told, not what the travel would round it to.
      const told = Math.abs(position - travel.position(value)) < 1e-9 ? value : travel.value(position);
      return told === 0 && zeroReads ? zeroReads : formatted(told, parameter.unit);
    },
    commit: (position) => commit(parameter, travel.value(position)),
  };
}
