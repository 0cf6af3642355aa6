// Handles the server's news of new, remade and evicted grids.

import { outdatedBy } from '../time/outdated';
import { allPanes } from '../scene/panes';
import { Region, isRegion, times } from '../wire/api';
import { App } from './app';
import { Loader } from './loader';
import { mostTimes, soonTimes } from './showing';
import { texts } from './texts';

// Greatest time between a grid and an instant of a region that uses the grid. The instant is at most 15 minutes from
// the grid's volume, and a volume takes some minutes.
const farthestMadeMs = 30 * 60 * 1000;

export class News {
    constructor(private app: App) {}

    // Call if news may be lost. Asks for all lists, and forgets all grids, because any grid may have been made again.
    async catchUp(): Promise<void> {
        const { app } = this;
        if (!app.book || app.domains.length === 0) return app.begin();
        await app.findDomains();
        app.tell('choices');
        const { state, shown } = app;
        app.loader.forgetAll(() => true);
        if (app.isOnMap) return;
        if (!shown) return app.choose(state.domain, app.askedMoment);
        // Ask again for the domain and moment that the user chose while there was no answer.
        if (shown.domain !== state.domain || shown.moment !== state.moment)
            return app.choose(state.domain, app.askedMoment);
        if (isRegion(state.domain)) return this.takeNewsOfSite(undefined);
        await this.takeNews(state.domain, state.moment, shown.time, '', mostTimes);
    }
    // Takes a new list of times. If the time that the user looks at was evicted, goes to the nearest time and says so.
    // If the user asked for a missing time, goes to the nearest time of the new list.
    private takeNewTimes(stored: string[]): void {
        const { app } = this;
        const [now, missedTime] = [app.timeline.now, app.missedTime];
        app.timeline.take(stored);
        const { at: shown, times: all, follows, isPlaying } = app.player;
        if (now === undefined || shown < 0 || follows || isPlaying) return;
        if (missedTime !== '' && app.timeline.find(missedTime)) app.miss('');
        else if (missedTime === '' && !all.includes(now)) app.miss(texts.notice.otherTime(now), now);
    }
    private isPartOfShown(domain: string | undefined): boolean {
        const { app } = this;
        const own = app.domains.find((one) => one.domain === app.state.domain) as Region | undefined;
        return (
            domain === app.state.domain ||
            (isRegion(app.state.domain) && (own?.moments.some((one) => one.sites.includes(domain ?? '')) ?? false))
        );
    }
    // Handles a new volume of a site of the shown region. Instants near the time `volume` may have changed; if `volume`
    // is undefined, any instant may have changed.
    private async takeNewsOfSite(volume: string | undefined): Promise<void> {
        const { app } = this;
        const { domain, moment } = app.state;
        const isLeft = app.showing.whetherLeft();
        await app.findRegion(domain);
        if (isLeft()) return;
        const isNear = (time: string) =>
            volume === undefined || Math.abs(Date.parse(time) - Date.parse(volume)) <= farthestMadeMs;
        for (const pane of allPanes(app.state)) {
            const of = `${domain}/${pane.moment}/`;
            app.loader.forgetAll((key) => key.startsWith(of) && isNear(key.slice(of.length)));
        }
        const stored = (await times(domain, moment, soonTimes)).times;
        if (isLeft()) return;
        this.takeNewTimes(stored);
        await app.showing.showTime();
    }

    // Handles an event of a domain and moment. `changedTime` is the time of a grid that was made or made again.
    // `oldest` is the first time that is left after an eviction. Asks for at most `most` times.
    async takeNews(
        domain: string | undefined,
        moment: string | undefined,
        changedTime: string | undefined,
        oldest = '',
        most = soonTimes,
    ): Promise<void> {
        const { app } = this;
        if (app.domains.length === 0) {
            if (!app.book) return app.begin();
            await app.findDomains();
            if (app.domain) await app.choose(app.state.domain, app.state.moment);
            return;
        }
        // Find domains again for an unknown moment, too, because a station's moments need not come together.
        const isKnown = app.domains.some(
            (one) =>
                one.domain === domain && (moment === undefined || one.moments.some((own) => own.moment === moment)),
        );
        if (domain !== undefined && !domain.includes('.') && !isKnown) {
            await app.findDomains();
            app.tell('choices');
        }
        const isOfShown = domain === app.state.domain && moment === app.state.moment;
        const isOld = changedTime
            ? outdatedBy(
                  `${domain}/${moment}`,
                  changedTime,
                  isOfShown ? app.timeline.stored : [],
                  `${app.state.domain}/${app.state.moment}`,
              )
            : () => false;
        app.loader.forgetAll(isOld);
        // A surface may be of another moment than the shown grid, and so may panes.
        const isShown = allPanes(app.state).some((pane) => [pane.moment, pane.layers.surface?.moment].includes(moment));
        if (moment === undefined || !this.isPartOfShown(domain) || !isShown) return;
        if (domain !== app.state.domain) return this.takeNewsOfSite(changedTime);
        if (moment !== app.state.moment) return changedTime === app.shown?.time ? app.showing.showTime() : undefined;
        const before = app.timeline.now;
        const { times: newest, more } = await times(domain, moment, most);
        if (domain !== app.state.domain || moment !== app.state.moment) return;
        // Keep older times only if the server has more than it listed; otherwise it has evicted them.
        this.takeNewTimes([
            ...app.timeline.stored.filter((time) => more && time >= oldest && time < newest[0]!),
            ...newest,
        ]);
        const now = app.timeline.now;
        const isOfNow = now !== undefined && isOld(Loader.key(domain, moment, now));
        // Show the time also if the picture is of another time, because an earlier load may have failed.
        if (now !== before || now !== app.shown?.time || isOfNow || now === changedTime) await app.showing.showTime();
        else app.tell('time');
    }
}
